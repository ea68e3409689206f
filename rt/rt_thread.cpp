#include "rt/rt_thread.h"

#include <sched.h>

#include <memory>
#include <system_error>
#include <utility>

namespace rt {

namespace {

struct Start {
  std::string name;
  std::function<void()> body;
};

void* run(void* argument) {
  const std::unique_ptr<Start> start(static_cast<Start*>(argument));
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

void set_policy(Attributes& attributes, const ThreadConfig& config) {
  if (config.fifo_priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = config.fifo_priority;
    pthread_attr_setinheritsched(attributes.get(), PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(attributes.get(), SCHED_FIFO);
    const int error = pthread_attr_setschedparam(attributes.get(), &parameter);
    if (error != 0) throw std::system_error(error, std::generic_category(), "thread " + config.name + ": priority");
  }
  if (config.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(static_cast<std::size_t>(config.cpu), &cpus);
    pthread_attr_setaffinity_np(attributes.get(), sizeof cpus, &cpus);
  }
}

}  // namespace

RtThread::~RtThread() { join(); }

void RtThread::start(const ThreadConfig& config, std::function<void()> body) {
  join();
  Attributes attributes;
  set_policy(attributes, config);
  auto start = std::make_unique<Start>(Start{config.name, std::move(body)});
  const int error = pthread_create(&handle_, attributes.get(), run, start.get());
  if (error != 0) throw std::system_error(error, std::generic_category(), "thread " + config.name);
  start.release();  // the new thread owns it now
  running_ = true;
}

void RtThread::join() noexcept {
  if (!running_) return;
  pthread_join(handle_, nullptr);
  running_ = false;
}

}  // namespace rt
