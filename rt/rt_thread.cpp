#include "rt/rt_thread.h"

#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

#include "rt/memory.h"

namespace rt {

namespace {

struct Start {
  std::string name;
  std::size_t prefault_bytes;
  std::function<void()> body;
};

void* run(void* argument) {
  const std::unique_ptr<Start> start(static_cast<Start*>(argument));
  prefault_stack(start->prefault_bytes);  // may allocate, therefore before the thread gets its name
  pthread_setname_np(pthread_self(), start->name.substr(0, 15).c_str());
  start->body();
  return nullptr;
}

class Attributes {
 public:
  Attributes() { pthread_attr_init(&value_); }
  ~Attributes() { pthread_attr_destroy(&value_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  [[nodiscard]] pthread_attr_t* get() noexcept { return &value_; }

 private:
  pthread_attr_t value_{};
};

// Half of the stack is left to the body; for an unknown size, no more than fits into the default of any system.
std::size_t prefault_bytes(const ThreadConfig& config) noexcept {
  constexpr std::size_t kOfUnknownStack = 1 << 20;
  return std::min(config.prefault_bytes, config.stack_bytes > 0 ? config.stack_bytes / 2 : kOfUnknownStack);
}

void check(int error, const ThreadConfig& config, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), "thread " + config.name + ": " + what);
}

void set_attributes(Attributes& attributes, const ThreadConfig& config) {
  if (config.fifo_priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = config.fifo_priority;
    pthread_attr_setinheritsched(attributes.get(), PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(attributes.get(), SCHED_FIFO);
    check(pthread_attr_setschedparam(attributes.get(), &parameter), config, "priority");
  }
  if (config.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    check(config.cpu < CPU_SETSIZE ? 0 : EINVAL, config, "cpu");
    CPU_SET(static_cast<std::size_t>(config.cpu), &cpus);
    check(pthread_attr_setaffinity_np(attributes.get(), sizeof cpus, &cpus), config, "cpu");
  }
  if (config.stack_bytes > 0) check(pthread_attr_setstacksize(attributes.get(), config.stack_bytes), config, "stack");
}

}  // namespace

RtThread::~RtThread() { join(); }

void RtThread::start(const ThreadConfig& config, std::function<void()> body) {
  join();
  Attributes attributes;
  set_attributes(attributes, config);
  auto start = std::make_unique<Start>(Start{config.name, prefault_bytes(config), std::move(body)});
  check(pthread_create(&handle_, attributes.get(), run, start.get()), config, "start");
  start.release();  // now owned by the new thread
  running_ = true;
}

void RtThread::join() noexcept {
  if (!running_) return;
  pthread_join(handle_, nullptr);
  running_ = false;
}

}  // namespace rt
