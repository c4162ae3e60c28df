// Data-parallel loops. The backend (oneTBB) is behind parallel.cpp; nothing else includes it.
#ifndef DUPIN_CORE_PARALLEL_H
#define DUPIN_CORE_PARALLEL_H

#include <cstddef>
#include <functional>

namespace dupin {

/// Largest number of worker threads `parallel_for` uses, the caller's included; 0 means one per core.
/// Results never depend on it: every loop writes only to the slots of its own indices.
void set_thread_limit(int threads);
int thread_limit();

/// Calls body(i) once for every i in [0, count), on several threads and in any order. `grain` indices run
/// in one task; small or single-threaded loops run inline. The body must not throw.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain = 1);

}  // namespace dupin

#endif
