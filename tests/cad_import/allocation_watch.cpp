#include "allocation_watch.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> g_largest{0};
}

void* operator new(std::size_t size) {
  std::size_t seen = g_largest;
  while (size > seen && !g_largest.compare_exchange_weak(seen, size)) {
  }
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace dupin::test {

void watch_allocations() {
  g_largest = 0;
}
std::size_t largest_allocation() {
  return g_largest;
}

}  // namespace dupin::test
