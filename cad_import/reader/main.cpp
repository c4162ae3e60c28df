// dupin-reader: the process in which CAD files are read. Not for calling by hand: it answers in frames
// (reader_protocol.h) through descriptor 3.
#include <fcntl.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <OSD_Parallel.hxx>
#include <OSD_ThreadPool.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <thread>

#include "../../core/parallel.h"
#include "../model_stream.h"
#include "../reader_protocol.h"
#include "import_shapes.h"

namespace dupin::reader {
namespace {

struct Arguments {
  ImportRequest request;
  long parent = 0;
  std::uint64_t memory_bytes = 0;
  double seconds = 0;
  int threads = 0;
};

bool parse(int argc, char** argv, Arguments& a) {
  int i = 1;
  for (; i + 1 < argc && std::strcmp(argv[i], "--") != 0; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    if (name == "--parent")
      a.parent = std::strtol(value.c_str(), nullptr, 10);
    else if (name == "--memory")
      a.memory_bytes = std::strtoull(value.c_str(), nullptr, 10);
    else if (name == "--seconds")
      a.seconds = std::strtod(value.c_str(), nullptr);
    else if (name == "--threads")
      a.threads = static_cast<int>(std::strtol(value.c_str(), nullptr, 10));
    else if (name == "--unit")
      a.request.read.assumed_unit = value;
    else if (name == "--mesh")
      a.request.mesh.deflection = std::strtod(value.c_str(), nullptr);
    else if (name == "--angle")
      a.request.mesh.angle_radians = std::strtod(value.c_str(), nullptr);
    else
      return false;
  }
  if (i + 2 != argc) return false;
  a.request.path = argv[i + 1];
  return true;
}

void limit(int resource, rlim_t soft, rlim_t hard) {
  rlimit current{};
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &current) != 0) return;
  const rlim_t ceiling = std::min(hard, current.rlim_max);
  const rlimit wanted{std::min(soft, ceiling), ceiling};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &wanted);
}

void apply_limits(const Arguments& a) {
  // Gone with the caller, however that ends; and no memory image of a crash.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (a.parent != 0 && ::getppid() != a.parent) std::_Exit(1);
  limit(RLIMIT_CORE, 0, 0);
  if (a.memory_bytes > 0) limit(RLIMIT_AS, a.memory_bytes, a.memory_bytes);
  if (a.seconds > 0) {
    // The caller watches the clock; this is for when the caller itself is stopped.
    const auto cpu = static_cast<rlim_t>(std::ceil(a.seconds * std::max(1, a.threads))) + 1;
    limit(RLIMIT_CPU, cpu, cpu + 5);
  }
}

void use_threads(int threads) {
  set_thread_limit(threads);
  ::mallopt(M_ARENA_MAX, 4);  // a heap a thread would eat up the address space that the memory limit counts
  if (threads > 0 && static_cast<unsigned>(threads) < std::thread::hardware_concurrency()) {
    OSD_Parallel::SetUseOcctThreads(true);  // these can be told how many to be
    OSD_ThreadPool::DefaultPool()->SetNbDefaultThreadsToLaunch(threads);
  }
}

int fail(const Status& status) {
  send_failure(kReaderPipe, status);
  return 1;
}

int out_of_memory() {
  return fail({StatusCode::limit, "reading needs more memory than the limit allows"});
}

int answer(const ImportRequest& request) {
  const Stage stage = [](const char* name, double fraction) {
    if (!send_stage(kReaderPipe, name, fraction)) std::_Exit(1);  // nobody listens any more
  };
  try {
    OCC_CATCH_SIGNALS
    const Result<Model> model = import_shapes(request, stage);
    if (!model.ok()) return fail(model.status());
    stage("handing over", 0);
    return send_model(kReaderPipe, write_model(*model)) ? 0 : 1;
  } catch (const Standard_OutOfMemory&) {
    return out_of_memory();
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const Standard_Failure& failure) {
    return fail({StatusCode::unreadable, std::string("the CAD kernel gave up: ") +
                                             failure.DynamicType()->Name() + " " +
                                             failure.GetMessageString()});
  } catch (const std::exception& failure) {
    return fail({StatusCode::unreadable, std::string("the CAD kernel gave up: ") + failure.what()});
  }
}

}  // namespace
}  // namespace dupin::reader

int main(int argc, char** argv) {
  using namespace dupin::reader;
  std::signal(SIGPIPE, SIG_IGN);
  Arguments arguments;
  if (!parse(argc, argv, arguments) || ::fcntl(dupin::kReaderPipe, F_GETFD) < 0) {
    std::fputs("dupin-reader is started by the dupin library; use the dupin command instead\n", stderr);
    return 2;
  }
  apply_limits(arguments);
  use_threads(arguments.threads);
  Message::DefaultMessenger()->ChangePrinters().Clear();
  // The answer is complete once it is written: the kernel takes the memory back faster than destructors
  // would.
  const int code = answer(arguments.request);
  std::fflush(nullptr);
  std::_Exit(code);
}
