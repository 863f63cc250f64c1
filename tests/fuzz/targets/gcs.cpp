// The two ends of GCS: what a controller takes from anybody, and what the driver takes from a controller.
#include "core/devices/manipulator.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/fake/commands.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "tests/fuzz/machine/target.h"
#include "tests/support/devices/following_machine.h"

namespace enc::fuzz {
namespace {

std::vector<std::string> words() {
  std::vector<std::string> all{" \n", "\n", "\x18", "\x05", " X 1", " X=1", "=", " R 1", "ALL", "e-3"};
  for (const gcs::Commands::Entry& one : gcs::Commands::all()) all.emplace_back(one.word);
  return all;
}

// However it is commanded, the machine stays within its reach; answers end with their line.
Target controller() {
  Target target;
  target.seeds = {"*IDN?\nCSV?\nERR?\nFRF?\nSVO?\nSPI?\nTMN?\nTMX?\nVLS?\nPOS?\nERR?\n",
                  "VLS 20\nMOV X 1 Y 2 Z 3 U 1 V 2 W 3\nPOS?\nERR?\n\x18"
                  "ERR?\n",
                  "SVO X 0 Y 1\nFRF X\n\x07MVR Z -0.5\nONT? X\nVMO? X 1.0\nHLP?\nHLT X\nSTP\n",
                  "SPI R 0 S 0 T 12.5\nSAI? ALL\nCST? X\nPUN?\n\x03\x04\x05\x06\x08\x09MOV? X Y\n"};
  target.tokens = words();
  target.run = [](const std::string& input) {
    test::FollowingMachine machine;
    gcs::Controller controller(machine, {});
    controller.cycle(Time{});
    const std::string answers(controller.take(input));
    expect(answers.empty() || answers.back() == '\n', "an answer has no end");
    controller.cycle(Time(Duration(50'000'000)));
    expect(machine.can.contains(machine.pose), "the machine is beyond its reach");
    return true;
  };
  target.bound = {1024, 4U << 20U};  // two letters may ask for a page of help
  return target;
}

// A conversation that lost nothing has said a pose; one that was garbled stays so and sends nothing more.
Target answers() {
  Target target;
  const std::string zero = "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n";
  target.seeds = {zero + "0\n", zero + "7\n", "W=30 \nV=-15 \nU=1e-3 \nX=1.25 \nY=0 \nZ=-25\n10\n"};
  target.tokens = words();
  target.run = [](const std::string& input) {
    const gcs::Stand stand{{0, 0, 0.1}, {0, 0, 0}, {0, 0, 0.3}};
    gcs::Conversation talk(gcs::GcsSettings{}, stand, {}, Duration{});
    static_cast<void>(talk.send(Duration{}));
    talk.take(input, Duration(1'000'000));
    const bool linked = talk.loss() == gcs::Loss::none;
    const bool sends = !talk.send(Duration(10'000'000)).empty();
    expect(talk.report().X_RH.valid(), "a position is no pose");
    expect(linked || !sends, "it speaks to a link that is lost");
    return linked && talk.answers() == 1;
  };
  return target;
}

const Offer kController("gcs_controller", &controller);
const Offer kAnswers("gcs_answers", &answers);

}  // namespace
}  // namespace enc::fuzz
