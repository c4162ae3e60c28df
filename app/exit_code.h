// The command's exit codes: what scripts rely on (docs/manual.md, "Exit codes").
#ifndef DUPIN_APP_EXIT_CODE_H
#define DUPIN_APP_EXIT_CODE_H

#include "../core/status.h"

namespace dupin::app {

inline constexpr int kDone = 0, kWrongUsage = 2, kUnreadable = 3, kPartial = 4, kLimitHit = 5, kNoDevice = 6;

inline int exit_code(StatusCode code) {
  switch (code) {
    case StatusCode::ok:
      return kDone;
    case StatusCode::invalid_argument:
      return kWrongUsage;
    case StatusCode::unreadable:
    case StatusCode::cannot_write:
      return kUnreadable;
    case StatusCode::partial:
      return kPartial;
    case StatusCode::limit:
    case StatusCode::cancelled:
      return kLimitHit;  // only a limit cancels work in the command
    case StatusCode::no_device:
      return kNoDevice;
  }
  return kWrongUsage;
}

}  // namespace dupin::app

#endif
