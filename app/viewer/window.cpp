// The window's files: opening, loading, watching; what it reports.
#include "window.h"

#include "legend.h"

#include <QDragEnterEvent>
#include <QFileInfo>
#include <QFileSystemWatcher>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QMimeData>
#include <QProgressBar>
#include <QToolButton>
#include <QTreeWidget>
#include <QUrl>
#include <algorithm>
#include <chrono>

namespace dupin::app {
namespace {

constexpr int kBeat = 10;  // milliseconds

QTreeWidgetItem* instance_item(const PreparedModel& prepared, std::size_t i, ObjectId object) {
  const Instance& instance = prepared.model->instances[i];
  const Part& part = prepared.model->parts[instance.part];
  const std::string& name = !instance.name.empty() ? instance.name : part.name;
  auto* item =
      new QTreeWidgetItem({name.empty() ? QString("part %1").arg(i + 1) : QString::fromStdString(name)});
  item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
  item->setCheckState(0, Qt::Checked);
  item->setData(0, Qt::UserRole, object);
  item->setData(0, Qt::UserRole + 1, static_cast<uint>(i));
  return item;
}

}  // namespace

double since_start() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Window::Window(const QString& units) {
  setWindowTitle("Dupin");
  resize(1200, 800);
  setAcceptDrops(true);
  loader_options_.units = units.toStdString();
  canvas_ = new Canvas(this);
  setCentralWidget(canvas_);
  legend_ = new Legend(canvas_);
  legend_->move(12, 12);
  make_panels();
  make_tools();
  watcher_ = new QFileSystemWatcher(this);
  connect(watcher_, &QFileSystemWatcher::fileChanged, this, [this](const QString& path) {
    changed_files_ << path;
    changes_.start(300);  // programs write in several steps
  });
  changes_.setSingleShot(true);
  connect(&changes_, &QTimer::timeout, this, [this] {
    for (std::size_t i = 0; i < files_.size(); ++i)
      if (changed_files_.contains(QString::fromStdString(files_[i]->path))) load(static_cast<int>(i));
    changed_files_.clear();
  });
  // How long events wait: a timer that is late by so much was kept from its turn.
  connect(&heart_, &QTimer::timeout, this, [this] {
    const double now = since_start();
    const bool busy = canvas_->preparing() ||
                      std::any_of(files_.begin(), files_.end(), [](const auto& f) { return f->loading; });
    if ((busy || was_busy_) && last_beat_ > 0)
      report_.longest_wait_ms = std::max(report_.longest_wait_ms, now - last_beat_ - kBeat);
    last_beat_ = now;
    was_busy_ = busy;
  });
  heart_.start(kBeat);
  canvas_->heard = [this](double waited) {
    if (was_busy_) report_.longest_input_ms = std::max(report_.longest_input_ms, waited);
  };
}

Window::~Window() {
  for (auto& file : files_) file->loader.reset();
}

void Window::paintEvent(QPaintEvent* event) {
  QMainWindow::paintEvent(event);
  if (report_.window_ms == 0) report_.window_ms = since_start();
}

// ---- files

void Window::open(const QStringList& files) {
  for (const QString& path : files) {
    const std::string absolute = QFileInfo(path).absoluteFilePath().toStdString();
    const auto same =
        std::find_if(files_.begin(), files_.end(), [&](const auto& f) { return f->path == absolute; });
    int index = static_cast<int>(same - files_.begin());
    if (same == files_.end()) {
      files_.push_back(std::make_unique<File>());
      files_.back()->path = absolute;
      files_.back()->item = new QTreeWidgetItem(tree_, {QFileInfo(path).fileName()});
      files_.back()->item->setExpanded(true);
    }
    load(index);
  }
}

void Window::unload(File& file) {
  file.loader.reset();
  ++file.generation;
  for (const ObjectId id : file.objects) canvas_->remove(id);
  file.objects.clear();
  qDeleteAll(file.item->takeChildren());
}

void Window::load(int index) {
  File& file = *files_[static_cast<std::size_t>(index)];
  unload(file);
  if (!watcher_->files().contains(QString::fromStdString(file.path)))
    watcher_->addPath(QString::fromStdString(file.path));
  file.loading = true;
  file.fraction = 0;
  const int generation = file.generation;
  // What the loader says is heard on the window's thread, and only while it is still this file's loader.
  const auto tell = [this, index, generation](auto what) {
    QMetaObject::invokeMethod(
        this,
        [this, index, generation, what] {
          if (files_[static_cast<std::size_t>(index)]->generation == generation) what();
        },
        Qt::QueuedConnection);
  };
  LoaderCallbacks callbacks;
  const auto told = std::make_shared<std::atomic<double>>(-100.0);
  callbacks.progress = [this, tell, index, told](const std::string& stage, double fraction) {
    const double now = since_start();
    if (now - *told < 40) return;
    *told = now;
    tell([this, index, stage, fraction] {
      files_[static_cast<std::size_t>(index)]->fraction = fraction;
      show_progress(stage);
    });
  };
  callbacks.ready = [this, tell, index](std::shared_ptr<const PreparedModel> model) {
    tell([this, index, model] { show_ready(index, model); });
  };
  callbacks.done = [this, tell, index](const Status& status) {
    tell([this, index, status] { loading_done(index, status); });
  };
  file.loader = std::make_unique<Loader>(file.path, loader_options_, callbacks);
  show_progress("read");
}

void Window::reload_all() {
  for (std::size_t i = 0; i < files_.size(); ++i) load(static_cast<int>(i));
}

void Window::show_ready(int index, std::shared_ptr<const PreparedModel> model) {
  File& file = *files_[static_cast<std::size_t>(index)];
  const ObjectId id = canvas_->add(model);
  if (id == 0) return;
  file.objects.push_back(id);
  QList<QTreeWidgetItem*> items;
  for (std::size_t i = 0; i < model->model->instances.size(); ++i) items << instance_item(*model, i, id);
  filling_tree_ = true;
  file.item->addChildren(items);
  filling_tree_ = false;
  canvas_->refit_box();
  // The camera stays where somebody has moved it; until everything is there it follows what comes.
  if (!fitted_) canvas_->camera.look_from("iso"), canvas_->refit_box();
  if (report_.first_parts_ms == 0) report_.first_parts_ms = since_start();
  for (const SkippedFace& face : model->model->skipped) say(face.name + ": " + face.reason, true);
}

void Window::loading_done(int index, const Status& status) {
  File& file = *files_[static_cast<std::size_t>(index)];
  file.loading = false;
  if (!status.ok()) say(status.message, status.code != StatusCode::cancelled);
  if (!file.objects.empty()) fitted_ = true;
  report_.loaded_ms = since_start();
  show_progress("");
}

void Window::show_progress(const std::string& stage) {
  double sum = 0;
  int loading = 0;
  for (const auto& file : files_)
    if (file->loading) sum += file->fraction, ++loading;
  progress_->setVisible(loading > 0);
  cancel_->setVisible(loading > 0);
  if (loading == 0) return;
  progress_->setValue(static_cast<int>(100 * sum / loading));
  progress_->setFormat(QString::fromStdString(stage) + " %p %");
}

void Window::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void Window::dropEvent(QDropEvent* event) {
  QStringList files;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) files << url.toLocalFile();
  open(files);
}

// ---- what a test asks

QByteArray Window::report_json() const {
  const Camera camera = canvas_->camera.camera();
  const auto vec = [](const Vec3& v) { return QJsonArray{v.x, v.y, v.z}; };
  QJsonObject json{{"window_ms", report_.window_ms},
                   {"first_parts_ms", report_.first_parts_ms},
                   {"loaded_ms", report_.loaded_ms},
                   {"longest_wait_ms", report_.longest_wait_ms},
                   {"longest_input_ms", report_.longest_input_ms},
                   {"frames", canvas_->frames()},
                   {"eye", vec(camera.eye)},
                   {"target", vec(camera.target)},
                   {"height", camera.ortho_height},
                   {"parallel", camera.orthographic},
                   {"shading", static_cast<int>(canvas_->options.shading)},
                   {"edges", canvas_->options.edges},
                   {"sections", static_cast<int>(canvas_->options.sections.size())},
                   {"message", QString::fromStdString(last_message_)}};
  int objects = 0, hidden = 0;
  for (const auto& file : files_) {
    objects += static_cast<int>(file->objects.size());
    for (int i = 0; i < file->item->childCount(); ++i)
      hidden += file->item->child(i)->checkState(0) == Qt::Unchecked;
  }
  json["files"] = static_cast<int>(files_.size());
  json["objects"] = objects;
  json["hidden"] = hidden;
  if (hit_)
    json["picked"] = QJsonObject{{"surface", QString::fromStdString(hit_->surface)},
                                 {"part", QString::fromStdString(hit_->part)},
                                 {"face", static_cast<int>(hit_->target.face)},
                                 {"area", area_},
                                 {"point", vec(hit_->point)}};
  return QJsonDocument(json).toJson();
}

}  // namespace dupin::app
