#include "firmware_app/service/service_notify.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "tests/support/notify_socket.h"

namespace app {
namespace {

using tests::NotifySocket;

TEST(ServiceNotify, SaysNothingWithoutAServiceManager) {
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  ServiceNotify service;
  EXPECT_EQ(service.feed_period_ns(), 0);
  service.ready("running");
  service.tick("");
  service.stopping();
}

TEST(ServiceNotify, TellsReadinessAndTheEnd) {
  const NotifySocket manager;
  if (!manager.is_heard()) GTEST_SKIP() << "built without libsystemd";
  const ServiceNotify service;
  service.ready("running");
  EXPECT_EQ(manager.receive(), "READY=1\nSTATUS=running");
  service.stopping();
  EXPECT_EQ(manager.receive(), "STOPPING=1");
}

TEST(ServiceNotify, FeedsTheWatchdogOnlyWhileNothingIsStalled) {
  const NotifySocket manager;
  if (!manager.is_heard()) GTEST_SKIP() << "built without libsystemd";
  setenv("WATCHDOG_USEC", "40000", 1);
  ServiceNotify service;
  unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(service.feed_period_ns(), 10'000'000);
  service.tick("");
  EXPECT_EQ(manager.receive(), "WATCHDOG=1");
  service.tick("");  // too early
  std::this_thread::sleep_for(std::chrono::milliseconds(11));
  service.tick("stage tracking: one step has taken 11.0 s");
  service.tick("stage tracking: one step has taken 11.1 s");
  EXPECT_EQ(manager.receive(), "STATUS=stalled: stage tracking: one step has taken 11.0 s") << "and no watchdog";
  service.tick("");
  EXPECT_EQ(manager.receive(), "STATUS=running again after a stall");
  EXPECT_EQ(manager.receive(), "WATCHDOG=1");
  EXPECT_EQ(manager.receive(), "");
}

}  // namespace
}  // namespace app
