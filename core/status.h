// How functions say that they could not do what was asked: a value, never an exception.
#ifndef DUPIN_CORE_STATUS_H
#define DUPIN_CORE_STATUS_H

#include <string>
#include <utility>
#include <variant>

namespace dupin {

/// Why something failed. The `dupin` command turns each kind into its documented exit code.
enum class StatusCode {
  ok,
  invalid_argument,  ///< the caller's options contradict each other or are out of range (exit 2)
  unreadable,        ///< a file is missing, damaged, empty or of a kind that is not supported (exit 3)
  partial,           ///< done, but something of the input was left out; it is listed (exit 4)
  limit,             ///< a limit of time, memory or size was hit (exit 5)
  no_device,         ///< no GL context of a usable version could be had (exit 6)
  cannot_write,      ///< an output could not be written (exit 3)
  cancelled,         ///< the caller's progress callback asked to stop
};

struct Status {
  StatusCode code = StatusCode::ok;
  std::string message;  ///< one line, for a person; empty when ok
  bool ok() const { return code == StatusCode::ok; }
};

/// A value, or the reason why there is none.
template <class T>
class Result {
 public:
  Result(T value) : state_(std::move(value)) {}           // NOLINT: implicit on purpose
  Result(Status failure) : state_(std::move(failure)) {}  // NOLINT: implicit on purpose
  Result(StatusCode code, std::string message) : state_(Status{code, std::move(message)}) {}
  bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  T& value() { return std::get<T>(state_); }
  const T& value() const { return std::get<T>(state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  Status status() const { return ok() ? Status{} : std::get<Status>(state_); }

 private:
  std::variant<T, Status> state_;
};

}  // namespace dupin

#endif
