#include "context.h"

#include "context_backends.h"

namespace dupin {

Result<std::unique_ptr<Context>> create_context(Device device) {
  if (device == Device::egl) return create_egl_context();
  if (device == Device::osmesa) return create_osmesa_context();
  auto egl = create_egl_context();
  if (egl) return egl;
  auto osmesa = create_osmesa_context();
  if (osmesa) return osmesa;
  return {StatusCode::no_device, egl.status().message + "; " + osmesa.status().message};
}

}  // namespace dupin
