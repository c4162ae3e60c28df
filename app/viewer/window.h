// The window: files, their parts, what is shown and how, and what is under the pointer.
#ifndef DUPIN_APP_VIEWER_WINDOW_H
#define DUPIN_APP_VIEWER_WINDOW_H

#include <QMainWindow>
#include <QStringList>
#include <map>
#include <memory>

#include "canvas.h"
#include "loader.h"

class QAction;
class QComboBox;
class QFileSystemWatcher;
class QLabel;
class QProgressBar;
class QSlider;
class QToolBar;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace dupin::app {

class Legend;

/// What the window did, for tests and measurements (dupin view --report).
struct ViewReport {
  double window_ms = 0, first_parts_ms = 0, loaded_ms = 0;  ///< since the program started; 0: not yet
  double longest_input_ms = 0;  ///< that a move of the pointer waited in that time
  double longest_wait_ms = 0;   ///< that an event had to wait while files were read, prepared and first drawn
};

class Window : public QMainWindow {
 public:
  explicit Window(const QString& units);
  ~Window() override;
  void open(const QStringList& files);
  Canvas& canvas() { return *canvas_; }
  const ViewReport& report() const { return report_; }
  /// Everything that can be asked of the window's state, as JSON.
  QByteArray report_json() const;

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  struct File {
    std::string path;
    std::unique_ptr<Loader> loader;
    std::vector<ObjectId> objects;
    QTreeWidgetItem* item = nullptr;
    int generation = 0;  ///< what an earlier loader still says is not listened to
    double fraction = 0;
    bool loading = false;
  };

  void make_tools();
  void make_view_tools(QToolBar& tools);
  void make_shading_tools(QToolBar& tools);
  void make_section_tools(QToolBar& tools);
  void make_panels();
  QAction* action(const QString& text, const QKeySequence& key, std::function<void()> run);
  void load(int index);
  void unload(File& file);
  void reload_all();
  void show_ready(int index, std::shared_ptr<const PreparedModel> model);
  void loading_done(int index, const Status& status);
  void show_progress(const std::string& stage);
  void look_from(const char* name);
  void shade(Shading shading);
  void apply_section();
  void show_hit(const std::optional<Hit>& hit);
  void say(const std::string& text, bool failure = false);
  void save_picture();

  Canvas* canvas_ = nullptr;
  Legend* legend_ = nullptr;
  QTreeWidget* tree_ = nullptr;
  QLabel *readout_ = nullptr, *frame_ = nullptr, *message_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QToolButton* cancel_ = nullptr;
  QComboBox *shading_ = nullptr, *primitive_ = nullptr, *tolerance_ = nullptr, *section_ = nullptr;
  QSlider* section_at_ = nullptr;
  QFileSystemWatcher* watcher_ = nullptr;
  QTimer changes_, heart_;
  QStringList changed_files_;
  std::vector<std::unique_ptr<File>> files_;
  LoaderOptions loader_options_;
  ViewReport report_;
  double last_beat_ = 0;
  bool filling_tree_ = false, fitted_ = false, was_busy_ = false;
  std::string last_message_;
  std::optional<Hit> hit_;
  double area_ = 0;
};

/// Milliseconds since the program started.
double since_start();

}  // namespace dupin::app

#endif
