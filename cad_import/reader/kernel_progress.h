// OCCT's progress as one of our stages.
#ifndef DUPIN_CAD_IMPORT_READER_KERNEL_PROGRESS_H
#define DUPIN_CAD_IMPORT_READER_KERNEL_PROGRESS_H

#include <Message_ProgressIndicator.hxx>

#include <algorithm>

#include "source_document.h"

namespace dupin::reader {

class KernelProgress : public Message_ProgressIndicator {
 public:
  KernelProgress(const Stage& stage, const char* name) : stage_(stage), name_(name) {}

 protected:
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {
    const double position = std::clamp(GetPosition(), 0.0, 1.0);
    if (position < shown_ + kStep) return;
    shown_ = position;
    stage_(name_, position);
  }

 private:
  static constexpr double kStep = 0.01;
  const Stage& stage_;
  const char* name_;
  double shown_ = 0;
};

}  // namespace dupin::reader

#endif
