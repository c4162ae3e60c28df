#include "picture_thread.h"

#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <thread>

namespace dupin::python {
namespace {

class PictureThread {
 public:
  PictureThread() {
    std::thread([this] { serve(); }).detach();
  }
  Status run(const std::function<Status(Renderer&)>& work) {
    if (::getpid() != process_)
      return {StatusCode::limit, "pictures cannot be drawn after a fork; use spawn"};
    const std::lock_guard one_at_a_time(callers_);
    std::unique_lock lock(mutex_);
    work_ = &work;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !work_; });
    return result_;
  }

 private:
  void serve() {
    Status status;
    auto context = create_context(Device::automatic);
    std::unique_ptr<Renderer> renderer;
    if (!context) {
      status = context.status();
    } else {
      auto made = Renderer::create((*context)->loader());
      if (made)
        renderer = std::move(*made);
      else
        status = made.status();
    }
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return work_ != nullptr; });
      result_ = renderer ? (*work_)(*renderer) : status;
      work_ = nullptr;
      changed_.notify_all();
    }
  }

  const pid_t process_ = ::getpid();
  std::mutex callers_, mutex_;
  std::condition_variable changed_;
  const std::function<Status(Renderer&)>* work_ = nullptr;
  Status result_;
};

}  // namespace

Status on_picture_thread(const std::function<Status(Renderer&)>& work) {
  // Lives as long as the process: an interpreter that ends does not wait for it.
  static PictureThread* const thread = new PictureThread;
  return thread->run(work);
}

}  // namespace dupin::python
