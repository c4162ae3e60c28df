// Inside the C interface: what its handles hold, and how failures come out.
#ifndef DUPIN_HOST_C_HANDLES_H
#define DUPIN_HOST_C_HANDLES_H

#include <algorithm>
#include <cstring>
#include <new>

#include "dupin.h"
#include "host_scene.h"
#include "load_job.h"

struct dupin_model {
  std::shared_ptr<const dupin::Model> model;
};
struct dupin_builder {
  dupin::Model model;
};
struct dupin_prepared {
  std::shared_ptr<const dupin::PreparedModel> prepared;
};
struct dupin_job {
  std::unique_ptr<dupin::LoadJob> job;
};
struct dupin_context {
  std::unique_ptr<dupin::Context> context;
};
struct dupin_scene {
  std::unique_ptr<dupin::HostScene> scene;
};

namespace dupin::c {

/// Keeps the message for dupin_last_message.
dupin_status failed(const Status& status);

/// Runs `work`, which returns a Status; nothing is thrown past it.
template <class Work>
dupin_status guarded(Work&& work) {
  try {
    const Status status = work();
    return status.ok() ? DUPIN_OK : failed(status);
  } catch (const std::bad_alloc&) {
    return failed({StatusCode::limit, "out of memory"});
  } catch (const std::exception& error) {
    return failed({StatusCode::limit, std::string("internal error: ") + error.what()});
  } catch (...) {
    return failed({StatusCode::limit, "internal error"});
  }
}

inline Status missing(const char* what) {
  return {StatusCode::invalid_argument, std::string(what) + " is NULL"};
}

/// The caller's struct as this version has it: what an older one lacks is 0.
template <class T>
T sized(const T* given) {
  T own{};
  if (given) std::memcpy(static_cast<void*>(&own), given, std::min(given->size, sizeof(T)));
  own.size = sizeof(T);
  return own;
}
/// Fills the caller's struct as far as it goes.
template <class T>
void give(const T& own, T* out) {
  const std::size_t size = std::min(out->size, sizeof(T));
  if (size <= sizeof(size_t)) return;
  std::memcpy(reinterpret_cast<char*>(out) + sizeof(size_t),
              reinterpret_cast<const char*>(&own) + sizeof(size_t), size - sizeof(size_t));
}

inline Vec3 vec3(const double* v) {
  return {v[0], v[1], v[2]};
}
inline std::optional<Color> color(const float* rgba) {
  if (!rgba) return {};
  return Color{rgba[0], rgba[1], rgba[2], rgba[3]};
}
inline Affine3 affine(const double* m) {
  if (!m) return {};
  Affine3 t;
  t.linear = {vec3(m), vec3(m + 4), vec3(m + 8)};
  t.translation = vec3(m + 12);
  return t;
}
inline std::string text(const char* given) {
  return given ? given : "";
}
inline Progress progress(dupin_progress callback, void* user) {
  if (!callback) return {};
  return [callback, user](std::string_view stage, double fraction) {
    return callback(user, std::string(stage).c_str(), fraction) != 0;
  };
}

}  // namespace dupin::c

#endif
