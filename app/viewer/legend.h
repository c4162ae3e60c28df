// What the colors of a curvature map mean.
#ifndef DUPIN_APP_VIEWER_LEGEND_H
#define DUPIN_APP_VIEWER_LEGEND_H

#include <QWidget>

namespace dupin::app {

class Legend : public QWidget {
 public:
  explicit Legend(QWidget* parent);
  /// From −scale to scale; "k1, 1/mm".
  void show_scale(const QString& title, double scale);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString title_;
  double scale_ = 1;
};

}  // namespace dupin::app

#endif
