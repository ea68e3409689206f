#include "firmware_app/service/stages/checkpoint_stage.h"

#include <exception>

#include "drivers/storage/checkpoint_file.h"

namespace app {

namespace {

void copy_used(const StateBytes& from, std::vector<std::uint8_t>& to) {
  to.assign(from.bytes.begin(), from.bytes.begin() + static_cast<std::ptrdiff_t>(from.n_used));
}

}  // namespace

rt::StepStatus CheckpointStage::step() noexcept {
  if (!spectrum_.refresh()) return spectrum_.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  rt::StageStats::add(stats().n_in);
  std::string failure;
  try {
    copy_used(spectrum_.front(), state_.spectrum);
    if (modes_.refresh()) copy_used(modes_.front(), state_.modes);
    failure = drivers::write_checkpoint(path_, to_bytes(state_));
  } catch (const std::exception&) {
    failure = "out of memory";
  }
  rt::StageStats::add(failure.empty() ? stats().n_out : stats().n_dropped);
  const std::lock_guard lock(mutex_);
  failure_ = std::move(failure);
  return rt::StepStatus::kWorked;
}

std::string CheckpointStage::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace app
