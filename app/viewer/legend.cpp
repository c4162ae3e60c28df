#include "legend.h"

#include <QPainter>
#include <array>
#include <cmath>

namespace dupin::app {
namespace {

/// The shaders' colors (render/shaders/looks.glsl, `diverging`), as a screen has them.
QColor diverging(double t) {
  using Rgb = std::array<double, 3>;
  const Rgb white{0.88, 0.87, 0.85};
  const Rgb end = t < 0 ? Rgb{0.024, 0.075, 0.42} : Rgb{0.42, 0.012, 0.022};
  const Rgb mid = t < 0 ? Rgb{0.17, 0.38, 0.80} : Rgb{0.82, 0.20, 0.11};
  const double u = std::abs(t);
  double out[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double linear =
        u < 0.5 ? white[k] + (mid[k] - white[k]) * 2 * u : mid[k] + (end[k] - mid[k]) * (2 * u - 1);
    out[k] = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  }
  return QColor::fromRgbF(out[0], out[1], out[2]);
}

}  // namespace

Legend::Legend(QWidget* parent) : QWidget(parent) {
  resize(120, 210);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hide();
}

void Legend::show_scale(const QString& title, double scale) {
  title_ = title;
  scale_ = scale;
  show();
  update();
}

void Legend::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), QColor(255, 255, 255, 225));
  painter.drawText(QRect(6, 4, width() - 8, 18), Qt::AlignLeft, title_);
  const int top = 28, bottom = height() - 12;
  for (int y = top; y < bottom; ++y) {
    painter.setPen(diverging(1 - 2.0 * (y - top) / (bottom - top)));
    painter.drawLine(8, y, 30, y);
  }
  painter.setPen(Qt::black);
  for (const double t : {1.0, 0.5, 0.0, -0.5, -1.0}) {
    const int y = top + static_cast<int>((1 - t) / 2 * (bottom - top));
    painter.drawLine(30, y, 34, y);
    painter.drawText(QRect(38, y - 9, width() - 40, 18), Qt::AlignVCenter,
                     QString::number(t * scale_, 'g', 3));
  }
}

}  // namespace dupin::app
