// The window's tools and panels.
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QLabel>
#include <QProgressBar>
#include <QSlider>
#include <QStatusBar>
#include <QToolBar>
#include <QToolButton>
#include <QTreeWidget>
#include <cmath>

#include "../../host/face_area.h"
#include "legend.h"
#include "window.h"

namespace dupin::app {
namespace {

struct ShadingChoice {
  const char* name;
  Shading shading;
  const char* legend;  ///< null: none
};
constexpr ShadingChoice kShadings[] = {{"Lit", Shading::lit, nullptr},
                                       {"Zebra", Shading::zebra, nullptr},
                                       {"k1", Shading::k1, "k1, 1/unit"},
                                       {"k2", Shading::k2, "k2, 1/unit"},
                                       {"Mean curvature", Shading::mean, "mean, 1/unit"},
                                       {"Normals", Shading::normal, nullptr},
                                       {"Faces", Shading::face, nullptr},
                                       {"Primitives", Shading::primitive, nullptr}};
constexpr double kTriangleDeflection = 1e-3;
/// The color map's ends, in 1 / diagonal.
constexpr double kCurvatureScale = 20;

QString number(double value) {
  return QString::number(value, 'g', 6);
}

}  // namespace

QAction* Window::action(const QString& text, const QKeySequence& key, std::function<void()> run) {
  auto* made = new QAction(text, this);
  made->setShortcut(key);
  made->setToolTip(key.isEmpty() ? text : text + " (" + key.toString() + ")");
  connect(made, &QAction::triggered, this, std::move(run));
  addAction(made);
  return made;
}

void Window::make_tools() {
  QToolBar* tools = addToolBar("Tools");
  tools->setMovable(false);
  tools->addAction(action("Open", QKeySequence::Open, [this] {
    open(QFileDialog::getOpenFileNames(this, "Open", {},
                                       "Models (*.step *.stp *.iges *.igs *.brep *.brp *.FCStd *.obj *.ply "
                                       "*.stl *.off *.gz);;All files (*)"));
  }));
  tools->addAction(action("Save picture", QKeySequence::Save, [this] { save_picture(); }));
  action("Reload", QKeySequence("R"), [this] { reload_all(); });
  action("Quit", QKeySequence("Ctrl+Q"), [this] { close(); });
  tools->addSeparator();
  make_view_tools(*tools);
  tools->addSeparator();
  make_shading_tools(*tools);
  tools->addSeparator();
  make_section_tools(*tools);
}

void Window::look_from(const char* name) {
  canvas_->refit_box();
  canvas_->camera.look_from(name);
  canvas_->changed();
}

void Window::make_view_tools(QToolBar& tools) {
  // FreeCAD's keys.
  struct {
    const char *text, *name, *key;
  } const sides[] = {{"Isometric", "iso", "0"}, {"Front", "front", "1"}, {"Top", "top", "2"},
                     {"Right", "right", "3"},   {"Back", "back", "4"},   {"Bottom", "bottom", "5"},
                     {"Left", "left", "6"}};
  auto* button = new QToolButton(&tools);
  button->setText("View");
  button->setPopupMode(QToolButton::InstantPopup);
  for (const auto& side : sides)
    button->addAction(
        action(side.text, QKeySequence(side.key), [this, name = side.name] { look_from(name); }));
  tools.addWidget(button);
  tools.addAction(action("Fit", QKeySequence("F"), [this] {
    canvas_->refit_box();
    canvas_->camera.fit();
    canvas_->changed();
  }));
  QAction* parallel = action("Parallel", QKeySequence("P"), [] {});
  parallel->setCheckable(true);
  connect(parallel, &QAction::toggled, this, [this](bool on) {
    canvas_->camera.set_parallel(on);
    canvas_->changed();
  });
  tools.addAction(parallel);
}

void Window::shade(Shading shading) {
  canvas_->options.shading = shading;
  const ShadingChoice* choice = nullptr;
  for (const ShadingChoice& c : kShadings)
    if (c.shading == shading) choice = &c;
  const Box3 box = canvas_->scene() ? canvas_->scene()->box() : Box3{};
  if (choice && choice->legend && box.diagonal() > 0) {
    canvas_->options.curvature_scale = kCurvatureScale / box.diagonal();
    legend_->show_scale(choice->legend, canvas_->options.curvature_scale);
  } else {
    legend_->hide();
  }
  canvas_->changed();
}

void Window::make_shading_tools(QToolBar& tools) {
  QAction* edges = action("Edges", QKeySequence("E"), [] {});
  edges->setCheckable(true);
  edges->setChecked(true);
  connect(edges, &QAction::toggled, this, [this](bool on) {
    canvas_->options.edges = on;
    canvas_->changed();
  });
  tools.addAction(edges);
  shading_ = new QComboBox(&tools);
  for (const ShadingChoice& choice : kShadings) shading_->addItem(choice.name);
  connect(shading_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int i) { shade(kShadings[i].shading); });
  tools.addWidget(shading_);
  const auto toggle = [this](int index) {
    shading_->setCurrentIndex(shading_->currentIndex() == index ? 0 : index);
  };
  action("Zebra", QKeySequence("Z"), [toggle] { toggle(1); });
  action("Curvature", QKeySequence("C"), [toggle] { toggle(4); });
  primitive_ = new QComboBox(&tools);
  primitive_->addItems({"Exact", "Triangles"});
  connect(primitive_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int i) {
    loader_options_.deflection = i == 1 ? kTriangleDeflection : 0;
    reload_all();
  });
  tools.addWidget(primitive_);
  tolerance_ = new QComboBox(&tools);
  for (const char* px : {"0.25 px", "0.5 px", "1 px", "2 px"}) tolerance_->addItem(px);
  tolerance_->setCurrentIndex(1);
  connect(tolerance_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int i) {
    canvas_->tolerance_px = 0.25 * (1 << i);
    canvas_->changed();
  });
  tools.addWidget(tolerance_);
}

void Window::make_section_tools(QToolBar& tools) {
  section_ = new QComboBox(&tools);
  section_->addItems({"No section", "Section X", "Section Y", "Section Z"});
  section_at_ = new QSlider(Qt::Horizontal, &tools);
  section_at_->setRange(0, 1000);
  section_at_->setValue(500);
  section_at_->setFixedWidth(140);
  connect(section_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] { apply_section(); });
  connect(section_at_, &QSlider::valueChanged, this, [this] { apply_section(); });
  tools.addWidget(section_);
  tools.addWidget(section_at_);
  action("Section", QKeySequence("S"),
         [this] { section_->setCurrentIndex((section_->currentIndex() + 1) % 4); });
}

void Window::apply_section() {
  canvas_->options.sections.clear();
  const int axis = section_->currentIndex() - 1;
  const Box3 box = canvas_->scene() ? canvas_->scene()->box() : Box3{};
  if (axis >= 0 && !box.empty()) {
    const Vec3 normals[] = {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};  // what is nearer in the isometric view goes
    const double t = section_at_->value() / 1000.0;
    const Vec3 at = box.lo + (box.hi - box.lo) * t;
    canvas_->options.sections.push_back({normals[axis], -dot(normals[axis], at)});
  }
  canvas_->changed();
}

void Window::make_panels() {
  auto* dock = new QDockWidget("Parts", this);
  tree_ = new QTreeWidget(dock);
  tree_->setHeaderHidden(true);
  tree_->setUniformRowHeights(true);
  dock->setWidget(tree_);
  addDockWidget(Qt::LeftDockWidgetArea, dock);
  connect(tree_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (filling_tree_ || !item->parent()) return;
    canvas_->set_visible({item->data(0, Qt::UserRole).toUInt(), item->data(0, Qt::UserRole + 1).toUInt()},
                         item->checkState(0) == Qt::Checked);
  });
  connect(tree_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) {
    if (item->parent())
      canvas_->select(Target{item->data(0, Qt::UserRole).toUInt(), item->data(0, Qt::UserRole + 1).toUInt()});
  });
  auto* second = new QDockWidget("Under the pointer", this);
  readout_ = new QLabel("Click on a face.", second);
  readout_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  readout_->setMargin(6);
  readout_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  second->setWidget(readout_);
  addDockWidget(Qt::LeftDockWidgetArea, second);

  frame_ = new QLabel(this), message_ = new QLabel(this);
  progress_ = new QProgressBar(this);
  progress_->setMaximumWidth(260);
  cancel_ = new QToolButton(this);
  cancel_->setText("Stop");
  progress_->hide(), cancel_->hide();
  connect(cancel_, &QToolButton::clicked, this, [this] {
    for (auto& file : files_)
      if (file->loading) file->loader->cancel();
  });
  action("Stop", QKeySequence("Escape"), [this] {
    cancel_->click();
    canvas_->select({});
    show_hit({});
  });
  statusBar()->addWidget(message_, 1);
  statusBar()->addPermanentWidget(progress_);
  statusBar()->addPermanentWidget(cancel_);
  statusBar()->addPermanentWidget(frame_);
  canvas_->picked = [this](const std::optional<Hit>& hit) { show_hit(hit); };
  canvas_->failed = [this](const std::string& why) { say(why, true); };
  canvas_->drawn = [this](const FrameStats& stats) {
    const QString bound =
        stats.bound_px > 0 ? QString("certified within %1 px, ").arg(stats.bound_px, 0, 'g', 2) : QString();
    frame_->setText(QString("%1%2 primitives, %3 ms")
                        .arg(bound)
                        .arg(stats.primitives)
                        .arg(stats.milliseconds, 0, 'f', 1));
  };
}

void Window::say(const std::string& text, bool failure) {
  last_message_ = text;
  message_->setText(QString::fromStdString(text));
  message_->setStyleSheet(failure ? "color: #a00000" : "");
}

void Window::show_hit(const std::optional<Hit>& hit) {
  hit_ = hit;
  area_ = 0;
  if (!hit) {
    readout_->setText("Click on a face.");
    return;
  }
  QString text = QString("<b>%1</b>").arg(QString::fromStdString(hit->surface));
  const auto line = [&](const QString& name, const QString& value) { text += "<br>" + name + ": " + value; };
  if (!hit->part.empty()) line("part", QString::fromStdString(hit->part).toHtmlEscaped());
  line("face", QString::number(hit->target.face + 1));
  if (hit->radius) line("radius", number(*hit->radius));
  if (std::isfinite(hit->k1)) line("k1", number(hit->k1)), line("k2", number(hit->k2));
  const PreparedModel* prepared = canvas_->scene()->model(hit->target.object);
  const Instance& instance = prepared->model->instances[hit->target.instance];
  const Part& part = prepared->model->parts[instance.part];
  if (hit->target.face < part.faces.size()) {
    const double scale = std::cbrt(std::abs(determinant(instance.to_world.linear)));
    area_ = face_area(part, part.faces[hit->target.face]) * scale * scale;
    line("area", number(area_));
  }
  line("at", QString("%1, %2, %3").arg(number(hit->point.x), number(hit->point.y), number(hit->point.z)));
  if (hit->edge)
    line("edge", QString("%1, %2 px away").arg(*hit->edge + 1).arg(hit->edge_distance_px, 0, 'f', 1));
  readout_->setText(text);
}

void Window::save_picture() {
  const QString path = QFileDialog::getSaveFileName(this, "Save picture", "picture.png", "PNG (*.png)");
  if (path.isEmpty()) return;
  if (canvas_->grabFramebuffer().save(path))
    say("saved " + path.toStdString());
  else
    say("cannot write " + path.toStdString(), true);
}

}  // namespace dupin::app
