// How much memory this program asks for at once.
#ifndef DUPIN_TESTS_CAD_IMPORT_ALLOCATION_WATCH_H
#define DUPIN_TESTS_CAD_IMPORT_ALLOCATION_WATCH_H

#include <cstddef>

namespace dupin::test {

void watch_allocations();
/// The largest single one since.
std::size_t largest_allocation();

}  // namespace dupin::test

#endif
