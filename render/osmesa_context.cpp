// OSMesa: Mesa's software renderer into memory. Its few declarations are repeated here, so that its headers
// are not needed.
#include <GL/glcorearb.h>

#include "context_backends.h"

namespace dupin {
namespace {

constexpr int kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33, kCoreProfile = 0x34, kMajorVersion = 0x36,
              kMinorVersion = 0x37;
constexpr int kRgba = 0x1908;

struct OsMesa {
  void* (*create)(const int* attributes, void* share) = nullptr;
  void (*destroy)(void* context) = nullptr;
  unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height) = nullptr;
  void* (*get_proc_address)(const char* name) = nullptr;
};

class OsMesaContext final : public Context {
 public:
  OsMesaContext(const OsMesa& osmesa, void* context) : osmesa_(osmesa), context_(context) {}
  ~OsMesaContext() override {
    release();
    osmesa_.destroy(context_);
  }
  Status make_current() override {
    // We only draw into framebuffer objects; the context itself still wants some memory.
    if (osmesa_.make_current(context_, pixels_, GL_UNSIGNED_BYTE, kSide, kSide)) return {};
    return {StatusCode::no_device, "OSMesa: OSMesaMakeCurrent failed"};
  }
  void release() override { osmesa_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  void* proc_address(const char* name) const override { return osmesa_.get_proc_address(name); }
  std::string name() const override { return "OSMesa"; }

 private:
  static constexpr int kSide = 16;
  OsMesa osmesa_;
  void* context_;
  unsigned char pixels_[kSide * kSide * 4] = {};
};

}  // namespace

Result<std::unique_ptr<Context>> create_osmesa_context() {
  void* library = open_library({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"});
  if (!library) return {StatusCode::no_device, "OSMesa: libOSMesa is not installed"};
  OsMesa osmesa;
  if (!find_function(library, "OSMesaCreateContextAttribs", osmesa.create) ||
      !find_function(library, "OSMesaDestroyContext", osmesa.destroy) ||
      !find_function(library, "OSMesaMakeCurrent", osmesa.make_current) ||
      !find_function(library, "OSMesaGetProcAddress", osmesa.get_proc_address))
    return {StatusCode::no_device, "OSMesa: the installed libOSMesa is too old"};
  const int attributes[] = {kFormat,       kRgba, kDepthBits,    0, kProfile, kCoreProfile,
                            kMajorVersion, 3,     kMinorVersion, 3, 0};
  void* context = osmesa.create(attributes, nullptr);
  if (!context) return {StatusCode::no_device, "OSMesa: no OpenGL 3.3 core context"};
  auto result = std::make_unique<OsMesaContext>(osmesa, context);
  const Status current = result->make_current();
  if (!current.ok()) return current;
  return std::unique_ptr<Context>(std::move(result));
}

}  // namespace dupin
