#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace drivers {

// Instructions that this process executes in user space, in the calling thread and in threads that it starts after
// construction. Where the kernel counts none (a virtual machine without counters, or not permitted) why_not() says so.
class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  [[nodiscard]] std::optional<std::uint64_t> count() const;  // since construction; none: not counted
  [[nodiscard]] const std::string& why_not() const noexcept { return why_not_; }  // empty: they are counted

 private:
  int descriptor_ = -1;
  std::string why_not_;
};

}  // namespace drivers
