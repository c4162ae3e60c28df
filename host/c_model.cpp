// The C interface to models: reading, looking into and preparing them, and jobs.
#include "../core/parallel.h"
#include "c_handles.h"
#include "memory_file.h"

namespace dupin::c {
namespace {

thread_local std::string last_message;

ImportOptions import_options(const dupin_load_options* given) {
  const dupin_load_options own = sized(given);
  ImportOptions options;
  options.time_limit_seconds = own.time_limit_seconds;
  options.memory_limit_bytes = own.memory_limit;
  if (own.assumed_unit) options.assumed_unit = own.assumed_unit;
  options.reader = text(own.reader);
  options.progress = progress(own.progress, own.user);
  return options;
}

PrepareOptions prepare_options(const dupin_prepare_options* given) {
  const dupin_prepare_options own = sized(given);
  PrepareOptions options;
  options.tolerance = own.tolerance;
  if (own.normal_tolerance != 0) options.normal_tolerance = own.normal_tolerance;
  options.progress = progress(own.progress, own.user);
  return options;
}

Status load(const std::string& path, const dupin_load_options* options, dupin_model** model) {
  auto read = import_cad(path, import_options(options));
  if (!read) return read.status();
  *model = new dupin_model{std::make_shared<const Model>(std::move(*read))};
  return {};
}

const Instance* instance_of(const dupin_model* model, std::uint32_t number) {
  if (!model || number >= model->model->instances.size()) return nullptr;
  return &model->model->instances[number];
}

std::uint64_t skipped_faces(const Model& model) {
  std::uint64_t count = 0;
  for (const SkippedFace& face : model.skipped) count += face.count;
  return count;
}

}  // namespace

dupin_status failed(const Status& status) {
  last_message = status.message;
  return static_cast<dupin_status>(status.code);
}

}  // namespace dupin::c

using namespace dupin;
using namespace dupin::c;

static_assert(static_cast<int>(StatusCode::cancelled) == DUPIN_CANCELLED);
static_assert(static_cast<int>(StatusCode::no_device) == DUPIN_NO_DEVICE);

const char* dupin_version(void) {
  return DUPIN_VERSION;
}
int dupin_abi(void) {
  return DUPIN_ABI;
}
const char* dupin_last_message(void) {
  return last_message.c_str();
}
void dupin_set_threads(int threads) {
  set_thread_limit(std::max(0, threads));
}

dupin_status dupin_model_load(const char* path, const dupin_load_options* options, dupin_model** model) {
  return guarded([&] {
    if (!path || !model) return missing(path ? "model" : "path");
    return load(path, options, model);
  });
}

dupin_status dupin_model_load_memory(const void* bytes, size_t size, const dupin_load_options* options,
                                     dupin_model** model) {
  return guarded([&]() -> Status {
    if (!bytes || !model) return missing(bytes ? "model" : "bytes");
    const MemoryFile file(bytes, size);
    if (!file.whole()) return {StatusCode::limit, "no file in memory could be made of the bytes"};
    return load(file.path(), options, model);
  });
}

void dupin_model_free(dupin_model* model) {
  delete model;
}

dupin_status dupin_model_get_info(const dupin_model* model, dupin_model_info* info) {
  return guarded([&]() -> Status {
    if (!model || !info) return missing(model ? "info" : "model");
    const Model& m = *model->model;
    const Box3 box = bounding_box(m);
    dupin_model_info own{};
    own.parts = static_cast<std::uint32_t>(m.parts.size());
    own.instances = static_cast<std::uint32_t>(m.instances.size());
    own.faces = face_instance_count(m);
    own.skipped = skipped_faces(m);
    const double values[6] = {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
    std::copy(values, values + 6, own.box);
    own.source = m.source.c_str(), own.format = m.format.c_str(), own.unit = m.unit_note.c_str();
    give(own, info);
    return {};
  });
}

const char* dupin_model_instance_name(const dupin_model* model, uint32_t instance) {
  const Instance* found = instance_of(model, instance);
  return found ? found->name.c_str() : nullptr;
}
const char* dupin_model_part_name(const dupin_model* model, uint32_t instance) {
  const Instance* found = instance_of(model, instance);
  return found ? model->model->parts[found->part].name.c_str() : nullptr;
}
uint32_t dupin_model_face_count(const dupin_model* model, uint32_t instance) {
  const Instance* found = instance_of(model, instance);
  return found ? static_cast<std::uint32_t>(face_count(model->model->parts[found->part])) : 0;
}
const char* dupin_model_note(const dupin_model* model, uint32_t number) {
  if (!model) return nullptr;
  const auto& skipped = model->model->skipped;
  const auto& notes = model->model->notes;
  if (number < notes.size()) return notes[number].c_str();
  number -= static_cast<std::uint32_t>(notes.size());
  return number < skipped.size() ? skipped[number].reason.c_str() : nullptr;
}

// ---- preparing

dupin_status dupin_prepare(const dupin_model* model, const dupin_prepare_options* options,
                           dupin_prepared** prepared) {
  return guarded([&]() -> Status {
    if (!model || !prepared) return missing(model ? "prepared" : "model");
    auto made = prepare(model->model, prepare_options(options));
    if (!made) return made.status();
    *prepared = new dupin_prepared{std::move(*made)};
    return {};
  });
}
void dupin_prepared_free(dupin_prepared* prepared) {
  delete prepared;
}
dupin_status dupin_prepared_model(const dupin_prepared* prepared, dupin_model** model) {
  return guarded([&]() -> Status {
    if (!prepared || !model) return missing(prepared ? "model" : "prepared");
    *model = new dupin_model{prepared->prepared->model};
    return {};
  });
}

dupin_status dupin_job_load(const char* path, const dupin_load_options* load_given,
                            const dupin_prepare_options* prepare_given, dupin_job** job) {
  return guarded([&]() -> Status {
    if (!path || !job) return missing(path ? "job" : "path");
    *job = new dupin_job{LoadJob::start(path, import_options(load_given), prepare_options(prepare_given))};
    return {};
  });
}
dupin_status dupin_job_prepare(const dupin_model* model, const dupin_prepare_options* prepare_given,
                               dupin_job** job) {
  return guarded([&]() -> Status {
    if (!model || !job) return missing(model ? "job" : "model");
    *job = new dupin_job{LoadJob::start(model->model, prepare_options(prepare_given))};
    return {};
  });
}
double dupin_job_fraction(const dupin_job* job, char* stage, size_t capacity) {
  if (!job) return 0;
  if (stage && capacity > 0) {
    const std::string name = job->job->stage();
    const std::size_t size = std::min(name.size(), capacity - 1);
    std::memcpy(stage, name.data(), size);
    stage[size] = 0;
  }
  return job->job->fraction();
}
int dupin_job_done(const dupin_job* job) {
  return job && job->job->done();
}
void dupin_job_cancel(dupin_job* job) {
  if (job) job->job->cancel();
}
dupin_status dupin_job_result(const dupin_job* job, dupin_prepared** prepared) {
  return guarded([&]() -> Status {
    if (!job || !prepared) return missing(job ? "prepared" : "job");
    auto made = job->job->result();
    if (!made) return made.status();
    *prepared = new dupin_prepared{std::move(*made)};
    return {};
  });
}
void dupin_job_free(dupin_job* job) {
  delete job;
}
