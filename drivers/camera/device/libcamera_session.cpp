#include "drivers/camera/device/libcamera_session.h"

#include <fmt/format.h>
#include <libcamera/libcamera.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "drivers/camera/device/gone_nodes.h"
#include "drivers/camera/device/libcamera_manager.h"
#include "drivers/camera/device/libcamera_modes.h"
#include "rt/spsc_ring.h"

namespace drivers {

namespace lc = libcamera;

namespace {

constexpr unsigned kBuffers = 6;
constexpr std::size_t kRingSlots = 64;  // always more than requests

}  // namespace

class LibcameraSession::Impl {
 public:
  Impl(const LibcameraWishes& wishes, rt::Wakeup& wakeup)
      : wishes_(wishes), manager_(libcamera_manager()), wakeup_(wakeup) {
    completed_.set_reader_wakeup(&wakeup);
    id_ = choose_camera(*manager_, wishes.camera);
    if (const std::string refused = configure(); !refused.empty()) throw std::runtime_error(id_ + ": " + refused);
  }
  ~Impl() {
    halt();
    close();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] std::string run() {
    if (!camera_) {
      if (std::string refused = configure(); !refused.empty()) return refused;
    }
    is_gone_.store(false, std::memory_order_relaxed);
    const lc::ControlList controls = first_controls();
    if (camera_->start(&controls) != 0) return "streaming cannot begin";
    is_running_ = true;
    for (const auto& request : requests_) {
      request->reuse(lc::Request::ReuseBuffers);
      if (camera_->queueRequest(request.get()) != 0) return "refuses a request";
    }
    return {};
  }

  void halt() noexcept {
    if (!is_running_) return;
    is_running_ = false;
    const bool reported = is_gone(), shown = !open_nodes_that_are_gone().empty();
    if (reported == shown) {
      camera_->stop();
    } else {  // only one of libcamera and the nodes says that it was unplugged
      abandon();
    }
    while (reader_.front() != nullptr) reader_.pop();
  }

  void close() noexcept {
    if (!camera_) return;
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
    requests_.clear();
    unmap();
    allocator_.reset();
    camera_config_.reset();
    camera_->release();
    camera_.reset();
    is_gone_.store(false, std::memory_order_relaxed);
  }

  [[nodiscard]] std::optional<Done> next() noexcept {
    lc::Request* const* slot = reader_.front();
    if (slot == nullptr) return std::nullopt;
    lc::Request& request = **slot;
    reader_.pop();
    Done done;
    done.cookie = request.cookie();
    const lc::FrameMetadata& seen = request.findBuffer(stream_)->metadata();
    done.is_whole = seen.status == lc::FrameMetadata::FrameSuccess;
    done.sequence = seen.sequence;
    const lc::ControlList& told = request.metadata();
    done.stamp_ns = told.get(lc::controls::SensorTimestamp).value_or(static_cast<std::int64_t>(seen.timestamp));
    done.exposure_ns = std::int64_t{1000} * told.get(lc::controls::ExposureTime).value_or(0);
    done.readout_ns = told.get(lc::controls::draft::SensorRollingShutterSkew).value_or(0);
    const Mapping& mapped = mappings_[done.cookie];
    done.bytes = mapped.bytes + mapped.offset;
    done.n_bytes = std::min<std::size_t>(seen.planes().front().bytesused, mapped.n_bytes - mapped.offset);
    return done;
  }

  [[nodiscard]] LumaStatus read(const Done& done, std::uint8_t* luma) noexcept {
    return luma_.read(done.bytes, done.n_bytes, luma);
  }

  [[nodiscard]] bool give_back(const Done& done, bool lock) {
    lc::Request& request = *requests_[done.cookie];
    const lc::ControlList found = lock ? request.metadata() : lc::ControlList();
    request.reuse(lc::Request::ReuseBuffers);
    if (lock) lock_controls(request, found);
    return camera_->queueRequest(&request) == 0;
  }

  [[nodiscard]] const lc::Size& size() const noexcept { return size_; }
  [[nodiscard]] std::string description() const {
    return fmt::format("{} (libcamera), {} {} x {}", id_, format_.toString(), size_.width, size_.height);
  }
  [[nodiscard]] bool is_running() const noexcept { return is_running_; }
  [[nodiscard]] bool is_gone() const noexcept { return is_gone_.load(std::memory_order_acquire); }

 private:
  struct Mapping {
    std::uint8_t* bytes = nullptr;
    std::size_t n_bytes = 0;
    unsigned offset = 0;  // of the image in the buffer
  };

  // libcamera detects only the removal of USB cameras (0.0.3, 0.4). If another kind of camera is gone, libcamera
  // terminates the process when that camera is stopped, and again when it comes back while its manager runs. So the
  // manager is ended here, and the camera's objects are neither stopped nor destroyed: some memory and descriptors are
  // lost each time. All nodes are let go: those that are not gone yet will be, and a device that was not unplugged
  // would stream for ever.
  void abandon() {
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
    unmap();
    manager_.reset();
    struct Abandoned {
      std::shared_ptr<lc::Camera> camera;
      std::unique_ptr<lc::CameraConfiguration> config;
      std::unique_ptr<lc::FrameBufferAllocator> allocator;
      std::vector<std::unique_ptr<lc::Request>> requests;
    };
    static auto* const for_ever = new std::vector<Abandoned>;
    for_ever->push_back({std::move(camera_), std::move(camera_config_), std::move(allocator_), std::move(requests_)});
    requests_.clear();
    let_go(open_camera_nodes());
  }
  void unmap() noexcept {
    for (const Mapping& mapped : mappings_) munmap(mapped.bytes, mapped.n_bytes);
    mappings_.clear();
  }

  // Acquires the camera and prepares everything except the stream. Returns the reason of a failure; empty: done.
  [[nodiscard]] std::string configure() {
    close();
    if (!manager_) manager_ = libcamera_manager();
    camera_ = manager_->get(id_);
    if (!camera_) return "is not attached";
    if (camera_->acquire() != 0) {
      camera_.reset();
      return "is in use by another program";
    }
    camera_config_ = camera_->generateConfiguration({lc::StreamRole::Viewfinder});
    if (!camera_config_ || camera_config_->empty()) return "has no stream for us";
    lc::StreamConfiguration& stream = camera_config_->at(0);
    const auto chosen = choose_mode(stream, wanted_size());
    if (!chosen) return "delivers no format that can be read here";
    stream.pixelFormat = chosen->format;
    stream.size = chosen->size;
    stream.bufferCount = kBuffers;
    // validate() adjusts settings that the hardware cannot provide: the result is read back.
    if (camera_config_->validate() == lc::CameraConfiguration::Invalid || camera_->configure(camera_config_.get()) != 0)
      return fmt::format("refuses {} {}", chosen->format.toString(), chosen->size.toString());
    if (stream.pixelFormat != chosen->format || (!size_.isNull() && stream.size != size_))
      return "makes another mode of what was asked: " + stream.toString();
    if (wishes_.width_px > 0 &&
        stream.size != lc::Size(static_cast<unsigned>(wishes_.width_px), static_cast<unsigned>(wishes_.height_px)))
      return fmt::format("camera.size = [{}, {}] becomes {}: set camera.size to that", wishes_.width_px,
                         wishes_.height_px, stream.size.toString());
    format_ = stream.pixelFormat;
    size_ = stream.size;
    luma_ = LumaReader(chosen->layout, static_cast<int>(size_.width), static_cast<int>(size_.height), stream.stride);
    return make_requests(stream.stream());
  }

  [[nodiscard]] lc::Size wanted_size() const {
    if (wishes_.width_px == 0) return size_;  // null before the first set-up
    return {static_cast<unsigned>(wishes_.width_px), static_cast<unsigned>(wishes_.height_px)};
  }

  [[nodiscard]] std::string make_requests(lc::Stream* stream) {
    stream_ = stream;
    allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
    if (allocator_->allocate(stream) < 0) return "has no memory for buffers";
    for (const auto& buffer : allocator_->buffers(stream)) {
      const lc::FrameBuffer::Plane& plane = buffer->planes().front();
      const std::size_t n_bytes = plane.offset + plane.length;
      void* bytes = mmap(nullptr, n_bytes, PROT_READ, MAP_SHARED, plane.fd.get(), 0);
      if (bytes == MAP_FAILED) return "its buffers cannot be mapped";
      mappings_.push_back({static_cast<std::uint8_t*>(bytes), n_bytes, plane.offset});
      requests_.push_back(camera_->createRequest(mappings_.size() - 1));
      if (!requests_.back() || requests_.back()->addBuffer(stream, buffer.get()) != 0) return "refuses a request";
    }
    camera_->requestCompleted.connect(this, &Impl::on_completed);
    camera_->disconnected.connect(this, &Impl::on_disconnected);
    return {};
  }

  // Called by libcamera's thread.
  void on_completed(lc::Request* request) noexcept {
    if (request->status() == lc::Request::RequestCancelled) return;
    if (lc::Request** slot = writer_.try_claim(); slot != nullptr) {  // never full: there are more slots than requests
      *slot = request;
      writer_.publish();
    }
  }
  void on_disconnected() noexcept {
    is_gone_.store(true, std::memory_order_release);  // acquire in is_gone()
    wakeup_.nudge();
  }

  [[nodiscard]] bool has(const lc::ControlId& id) const { return camera_->controls().count(&id) > 0; }

  [[nodiscard]] lc::ControlList first_controls() const {
    lc::ControlList controls(camera_->controls());
    if (wishes_.rate_hz > 0 && has(lc::controls::FrameDurationLimits)) {
      const auto period_us = static_cast<std::int64_t>(std::llround(1e6 / wishes_.rate_hz));
      controls.set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>({period_us, period_us}));
    }
    if (wishes_.exposure_ms > 0 && has(lc::controls::ExposureTime)) {
      if (has(lc::controls::AeEnable)) controls.set(lc::controls::AeEnable, false);
      controls.set(lc::controls::ExposureTime, static_cast<std::int32_t>(1e3 * wishes_.exposure_ms));
    }
    return controls;
  }

  void lock_controls(lc::Request& request, const lc::ControlList& found) const {
    const auto set = [&](const auto& control, auto value) {
      if (has(control)) request.controls().set(control, value);
    };
    set(lc::controls::AeEnable, false);
    if (const auto exposure = found.get(lc::controls::ExposureTime)) set(lc::controls::ExposureTime, *exposure);
    if (const auto gain = found.get(lc::controls::AnalogueGain)) set(lc::controls::AnalogueGain, *gain);
    set(lc::controls::AwbEnable, false);
    set(lc::controls::AfMode, static_cast<std::int32_t>(lc::controls::AfModeManual));
  }

  LibcameraWishes wishes_;
  std::shared_ptr<lc::CameraManager> manager_;  // null after a camera was abandoned
  rt::Wakeup& wakeup_;
  std::string id_;
  std::shared_ptr<lc::Camera> camera_;  // acquired; null while it is gone
  std::unique_ptr<lc::CameraConfiguration> camera_config_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  lc::Stream* stream_ = nullptr;
  lc::PixelFormat format_;
  lc::Size size_;
  LumaReader luma_{PixelLayout::kGray8, 1, 1, 0};
  std::vector<Mapping> mappings_;  // index: a request's cookie
  std::vector<std::unique_ptr<lc::Request>> requests_;
  rt::SpscRing<lc::Request*> completed_{kRingSlots, nullptr};
  rt::RingWriter<lc::Request*> writer_ = completed_.writer();  // libcamera's thread
  rt::RingReader<lc::Request*> reader_ = completed_.reader();  // the capturing thread
  std::atomic<bool> is_gone_{false};
  bool is_running_ = false;
};

LibcameraSession::LibcameraSession(const LibcameraWishes& wishes, rt::Wakeup& wakeup)
    : impl_(std::make_unique<Impl>(wishes, wakeup)) {}
LibcameraSession::~LibcameraSession() = default;
int LibcameraSession::width_px() const noexcept { return static_cast<int>(impl_->size().width); }
int LibcameraSession::height_px() const noexcept { return static_cast<int>(impl_->size().height); }
std::string LibcameraSession::description() const { return impl_->description(); }
std::string LibcameraSession::run() { return impl_->run(); }
void LibcameraSession::halt() noexcept { impl_->halt(); }
void LibcameraSession::close() noexcept { impl_->close(); }
bool LibcameraSession::is_running() const noexcept { return impl_->is_running(); }
bool LibcameraSession::is_gone() const noexcept { return impl_->is_gone(); }
bool LibcameraSession::has_vanished() const { return !open_nodes_that_are_gone().empty(); }
std::optional<LibcameraSession::Done> LibcameraSession::next() noexcept { return impl_->next(); }
LumaStatus LibcameraSession::read(const Done& done, std::uint8_t* luma) noexcept { return impl_->read(done, luma); }
bool LibcameraSession::give_back(const Done& done, bool lock) { return impl_->give_back(done, lock); }

}  // namespace drivers
