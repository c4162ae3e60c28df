// dupin-view: the window of `dupin view`.
#include <QApplication>
#include <QCommandLineParser>
#include <QFile>
#include <QSurfaceFormat>
#include <cstdio>

#include "../exit_code.h"
#include "window.h"

namespace {

bool write(const QString& path, const QByteArray& bytes) {
  QFile file(path);
  return file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size();
}

}  // namespace

int main(int argc, char** argv) {
  dupin::app::since_start();
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication application(argc, argv);
  QApplication::setApplicationName("dupin");
  QCommandLineParser parser;
  parser.addHelpOption();
  parser.addPositionalArgument("FILE...", "models");
  parser.addOption({"units", "The unit of files that name none", "UNIT", "mm"});
  parser.addOption({"report", "Write what the window did, as JSON, when it closes", "FILE.json"});
  parser.process(application);
  dupin::app::Window window(parser.value("units"));
  window.show();
  // The window is up before anything is read.
  QTimer::singleShot(0, &window, [&] { window.open(parser.positionalArguments()); });
  const int code = application.exec();
  const QString report = parser.value("report");
  if (!report.isEmpty() && !write(report, window.report_json())) {
    std::fprintf(stderr, "dupin: %s: cannot write\n", report.toLocal8Bit().constData());
    return dupin::app::kUnreadable;
  }
  return code;
}
