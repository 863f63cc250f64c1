// Each cause of a refused priority has its own remedy.
#include "trial/time/real_time.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

namespace enc::trial {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(RealTimeRefusal, AUserIsSentToLimitsConf) {
  EXPECT_THAT(real_time_refusal(EPERM, {.most = 0}), HasSubstr("/etc/security/limits.conf: rtprio 41"));
  EXPECT_THAT(real_time_refusal(EPERM, {.most = 39}), HasSubstr("limits.conf")) << "less than is asked for";
}

// EPERM although the right is there: by CAP_SYS_NICE, as root has it, or by the limit.
TEST(RealTimeRefusal, AContainerWithoutABudgetIsNotSentToLimitsConf) {
  for (const RealTimeRights& rights :
       {RealTimeRights{.root = true, .sys_nice = true},
        RealTimeRights{.root = true, .sys_nice = true, .container = true},
        RealTimeRights{.container = true, .most = 41}, RealTimeRights{.most = 99}}) {
    const std::string words = real_time_refusal(EPERM, rights);
    EXPECT_THAT(words, HasSubstr("no real-time budget: docker run --cpu-rt-runtime=950000"));
    EXPECT_THAT(words, Not(HasSubstr("limits.conf")));
  }
}

TEST(RealTimeRefusal, AContainerWithoutTheRightIsToldHowToGetIt) {
  for (const RealTimeRights& rights :
       {RealTimeRights{.root = true}, RealTimeRights{.root = true, .container = true},
        RealTimeRights{.container = true}}) {
    const std::string words = real_time_refusal(EPERM, rights);
    EXPECT_THAT(words, HasSubstr("docker run --cap-add=SYS_NICE --ulimit rtprio=41"));
    EXPECT_THAT(words, Not(HasSubstr("limits.conf")));
  }
}

TEST(RealTimeRefusal, AnotherErrorIsNamed) {
  EXPECT_THAT(real_time_refusal(ENOSYS, {.root = true, .sys_nice = true}),
              HasSubstr("the system refuses SCHED_FIFO: Function not implemented"));
}

// Whatever this system grants, the words say it and the thread is as before afterwards.
TEST(RealTimeRefusal, ATrialOfThePriorityLeavesTheThreadAsItWas) {
  int before = 0, after = 0;
  sched_param parameter{};
  pthread_getschedparam(pthread_self(), &before, &parameter);
  {
    const RealTime tried(true);
    EXPECT_EQ(tried.granted(), tried.refusal().empty());
    EXPECT_THAT(tried.words(),
                HasSubstr(tried.granted() ? "SCHED_FIFO 40" : "not first (" + tried.refusal()));
  }
  pthread_getschedparam(pthread_self(), &after, &parameter);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace enc::trial
