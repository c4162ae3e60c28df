#include "load_job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace dupin {

class LoadJob::Impl {
 public:
  using Prepared = std::shared_ptr<const PreparedModel>;
  using Work = std::function<Result<Prepared>()>;

  ~Impl() {
    cancelled = true;
    if (thread.joinable()) thread.join();
  }
  void run(const Work& work, const std::function<void()>& finished) {
    thread = std::thread([this, work, finished] {
      Result<Prepared> made = guarded(work);
      {
        const std::lock_guard guard(mutex);
        result = std::move(made);
        is_done = true;
      }
      changed.notify_all();
      if (finished) finished();
    });
  }
  Progress progress(Progress own) {
    return [this, own = std::move(own)](std::string_view name, double part) {
      {
        const std::lock_guard guard(mutex);
        stage = name;
        fraction = part;
      }
      return report(own, name, part) && !cancelled;
    };
  }

  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  std::atomic<bool> cancelled{false};
  bool is_done = false;
  double fraction = 0;
  std::string stage = "starting";
  Result<Prepared> result{StatusCode::cancelled, "not done"};

 private:
  /// Memory that runs out must not end the host.
  Result<Prepared> guarded(const Work& work) {
    try {
      Result<Prepared> made = work();
      if (cancelled) return {StatusCode::cancelled, "loading was stopped"};
      return made;
    } catch (const std::exception& error) {
      return {StatusCode::limit, std::string("loading failed: ") + error.what()};
    }
  }
  std::thread thread;
};

std::unique_ptr<LoadJob> LoadJob::start(const std::string& path, ImportOptions import, PrepareOptions prepare,
                                        std::function<void()> finished) {
  std::unique_ptr<LoadJob> job(new LoadJob(std::make_unique<Impl>()));
  Impl& impl = *job->impl_;
  import.progress = impl.progress(std::move(import.progress));
  prepare.progress = impl.progress(std::move(prepare.progress));
  impl.run(
      [path, import, prepare]() -> Result<Impl::Prepared> {
        auto model = import_cad(path, import);
        if (!model) return model.status();
        return dupin::prepare(std::make_shared<Model>(std::move(*model)), prepare);
      },
      finished);
  return job;
}

std::unique_ptr<LoadJob> LoadJob::start(std::shared_ptr<const Model> model, PrepareOptions prepare,
                                        std::function<void()> finished) {
  std::unique_ptr<LoadJob> job(new LoadJob(std::make_unique<Impl>()));
  prepare.progress = job->impl_->progress(std::move(prepare.progress));
  job->impl_->run([model, prepare] { return dupin::prepare(model, prepare); }, finished);
  return job;
}

LoadJob::LoadJob(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LoadJob::~LoadJob() = default;

double LoadJob::fraction() const {
  const std::lock_guard guard(impl_->mutex);
  return impl_->fraction;
}

std::string LoadJob::stage() const {
  const std::lock_guard guard(impl_->mutex);
  return impl_->stage;
}

void LoadJob::cancel() {
  impl_->cancelled = true;
}

bool LoadJob::done() const {
  const std::lock_guard guard(impl_->mutex);
  return impl_->is_done;
}

bool LoadJob::wait(double seconds) const {
  std::unique_lock lock(impl_->mutex);
  return impl_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                 [&] { return impl_->is_done; });
}

Result<std::shared_ptr<const PreparedModel>> LoadJob::result() const {
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [&] { return impl_->is_done; });
  return impl_->result;
}

}  // namespace dupin
