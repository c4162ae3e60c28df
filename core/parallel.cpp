#include "parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace dupin {
namespace {
std::atomic<int> g_thread_limit{0};
}

void set_thread_limit(int threads) {
  g_thread_limit = std::max(0, threads);
}

int thread_limit() {
  const int limit = g_thread_limit;
  return limit > 0 ? limit : tbb::info::default_concurrency();
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain) {
  const int threads = thread_limit();
  if (threads <= 1 || count <= std::max<std::size_t>(1, grain)) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(1, grain)),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
  });
}

}  // namespace dupin
