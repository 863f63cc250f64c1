#include "core/control/task/state.h"

#include <gtest/gtest.h>

#include "core/record/state_hash.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

struct Count {
  int leaves = 0;
  template <class T>
  void operator()(std::string_view, T&) {
    ++leaves;
  }
};
template <class Task>
int leaves_of() {
  Count count;
  State state;
  state.task = typename Task::Memory();
  fields(count, state);
  return count.leaves;
}

// What other tasks remember is neither there nor hashed.
TEST(State, ATickHashesWhatItsTaskHas) {
  Count shared;
  State state;
  fields(shared, state);
  for (const int leaves : {leaves_of<Render>(), leaves_of<Meet>(), leaves_of<Probe>(), leaves_of<Travel>()}) {
    EXPECT_GT(leaves, shared.leaves);
    EXPECT_LT(leaves, shared.leaves + 125);
  }
  EXPECT_GE(leaves_of<Push>(), leaves_of<Meet>() + 9 * static_cast<int>(kMostMoving));
}

TEST(State, AStateHasTheMemoryOfItsScenesTask) {
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(loop.state.task));
  EXPECT_EQ(recall<Rendering>(loop.state).contact.object, -1) << "nothing yet";
  loop.tick();
  EXPECT_TRUE(std::holds_alternative<Rendering>(loop.state.task));
  EXPECT_FALSE(recall<Meeting>(loop.state).aim.target.finite()) << "another task's";
  EXPECT_TRUE(recall<Commanded>(loop.state).command.finite()) << "what several tasks share";
}

// A state goes on in a scene of another task as one that knows nothing of it.
TEST(State, OfAnotherTaskBeginsAnew) {
  Loop loop(prepare(test::ball_scene(), RigSpec{}));
  loop.tick(500);
  EXPECT_TRUE(loop.state.started && loop.out.tip.valid());
  loop.state.task.emplace<Probing>().phase = ProbePhase::push;
  loop.tick();
  EXPECT_TRUE(std::holds_alternative<Rendering>(loop.state.task));
  EXPECT_TRUE(loop.out.tip.valid()) << "it begins where the machine is";
}

TEST(State, ABallsSceneRemembersItsPart) {
  RecordProperty("state_bytes", static_cast<int>(sizeof(State)));
  RecordProperty("of_a_ball", static_cast<int>(remembered<Render>()));
  std::printf(
      "State %zu bytes; of a scene that renders %zu, meets %zu, pushes %zu, probes %zu, travels %zu\n",
      sizeof(State), remembered<Render>(), remembered<Meet>(), remembered<Push>(), remembered<Probe>(),
      remembered<Travel>());
  EXPECT_LT(remembered<Render>(), 1200U);  // 96 of them of its passivity controller
  EXPECT_GT(sizeof(State), remembered<Render>() + 500U) << "what only other tasks need";
}

}  // namespace
}  // namespace enc
