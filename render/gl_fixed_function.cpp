#include "gl_fixed_function.h"

#include <iterator>
#include <tuple>

namespace dupin {
namespace {

// The specification's values; core headers lack the names.
constexpr GLenum kAlphaTest = 0x0BC0, kPolygonStipple = 0x0B42;
constexpr GLenum kClampVertexColor = 0x891A, kClampFragmentColor = 0x891B;
constexpr GLenum kClamps[] = {GL_CLAMP_READ_COLOR, kClampVertexColor, kClampFragmentColor};

struct Transfer {
  GLenum name;
  GLfloat neutral;
};
constexpr Transfer kTransfers[] = {
    {0x0D10, 0}, {0x0D11, 0},  // map color, map stencil
    {0x0D12, 0}, {0x0D13, 0},  // index shift and offset
    {0x0D14, 1}, {0x0D15, 0},  // red scale and bias
    {0x0D18, 1}, {0x0D19, 0},  // green
    {0x0D1A, 1}, {0x0D1B, 0},  // blue
    {0x0D1C, 1}, {0x0D1D, 0},  // alpha
    {0x0D1E, 1}, {0x0D1F, 0},  // depth
};

}  // namespace

FixedFunctionState::FixedFunctionState(const Gl& gl) : gl_(gl) {
  static_assert(std::size(kTransfers) == std::tuple_size_v<decltype(transfers_)>);
  gl_.GetIntegerv(kClamps[0], &clamps_[0]);
  if (!gl_.compatibility()) return;
  for (std::size_t i = 1; i < clamps_.size(); ++i) gl_.GetIntegerv(kClamps[i], &clamps_[i]);
  alpha_test_ = gl_.IsEnabled(kAlphaTest);
  stipple_ = gl_.IsEnabled(kPolygonStipple);
  for (std::size_t i = 0; i < transfers_.size(); ++i) gl_.GetFloatv(kTransfers[i].name, &transfers_[i]);
}

void FixedFunctionState::neutral() const {
  gl_.ClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
  if (!gl_.compatibility()) return;
  gl_.ClampColor(kClampVertexColor, GL_FALSE), gl_.ClampColor(kClampFragmentColor, GL_FALSE);
  gl_.Disable(kAlphaTest);
  gl_.Disable(kPolygonStipple);
  for (const Transfer& transfer : kTransfers) gl_.PixelTransferf(transfer.name, transfer.neutral);
}

void FixedFunctionState::put_back() const {
  gl_.ClampColor(kClamps[0], static_cast<GLenum>(clamps_[0]));
  if (!gl_.compatibility()) return;
  for (std::size_t i = 1; i < clamps_.size(); ++i)
    gl_.ClampColor(kClamps[i], static_cast<GLenum>(clamps_[i]));
  (alpha_test_ ? gl_.Enable : gl_.Disable)(kAlphaTest);
  (stipple_ ? gl_.Enable : gl_.Disable)(kPolygonStipple);
  for (std::size_t i = 0; i < transfers_.size(); ++i) gl_.PixelTransferf(kTransfers[i].name, transfers_[i]);
}

}  // namespace dupin
