// What hypre asks of MPI, answered for a world of one process that exchanges nothing: collective operations
// copy, and there is nobody to send to. Symbols that hypre's archive names but that one process's setup never
// reaches stop the program by name.
#include <mpi.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#ifndef OPEN_MPI
#error "written for Open MPI's mpi.h, which Debian's hypre is built with"
#endif

// mpi.h leaves these types open: here a datatype is its size.
struct ompi_predefined_datatype_t {
  std::size_t size;
};
struct ompi_predefined_op_t {
  int unused;
};
struct ompi_predefined_communicator_t {
  int unused;
};
struct ompi_predefined_request_t {
  int unused;
};

namespace {

std::size_t bytes(MPI_Datatype type, int count) {
  return reinterpret_cast<const ompi_predefined_datatype_t*>(type)->size * static_cast<std::size_t>(count);
}

int copy(const void* from, void* to, MPI_Datatype type, int count) {
  if (from != MPI_IN_PLACE && to != MPI_IN_PLACE && from != to && count > 0)
    std::memmove(to, from, bytes(type, count));
  return MPI_SUCCESS;
}

}  // namespace

extern "C" {

ompi_predefined_datatype_t ompi_mpi_byte{1}, ompi_mpi_int{sizeof(int)}, ompi_mpi_long{sizeof(long)},
    ompi_mpi_double{sizeof(double)};
ompi_predefined_op_t ompi_mpi_op_sum, ompi_mpi_op_max, ompi_mpi_op_min, ompi_mpi_op_lor;
ompi_predefined_communicator_t ompi_mpi_comm_self, ompi_mpi_comm_world, ompi_mpi_comm_null;
ompi_predefined_request_t ompi_request_null;

int MPI_Comm_rank(MPI_Comm, int* rank) {
  return *rank = 0, MPI_SUCCESS;
}
int MPI_Comm_size(MPI_Comm, int* size) {
  return *size = 1, MPI_SUCCESS;
}
int MPI_Comm_dup(MPI_Comm comm, MPI_Comm* copied) {
  return *copied = comm, MPI_SUCCESS;
}
int MPI_Comm_free(MPI_Comm* comm) {
  return *comm = MPI_COMM_NULL, MPI_SUCCESS;
}
/// The only group, and the only communicator of it, is this process.
int MPI_Comm_group(MPI_Comm, MPI_Group* group) {
  return *group = nullptr, MPI_SUCCESS;
}
int MPI_Group_incl(MPI_Group, int, const int*, MPI_Group* group) {
  return *group = nullptr, MPI_SUCCESS;
}
int MPI_Group_free(MPI_Group*) {
  return MPI_SUCCESS;
}
int MPI_Comm_create(MPI_Comm comm, MPI_Group, MPI_Comm* created) {
  return *created = comm, MPI_SUCCESS;
}
int MPI_Barrier(MPI_Comm) {
  return MPI_SUCCESS;
}
int MPI_Bcast(void*, int, MPI_Datatype, int, MPI_Comm) {
  return MPI_SUCCESS;
}
int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Reduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op, int, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Scan(const void* from, void* to, int count, MPI_Datatype type, MPI_Op, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Allgather(const void* from, int count, MPI_Datatype type, void* to, int, MPI_Datatype, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Gather(const void* from, int count, MPI_Datatype type, void* to, int, MPI_Datatype, int, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Scatter(const void* from, int count, MPI_Datatype type, void* to, int, MPI_Datatype, int, MPI_Comm) {
  return copy(from, to, type, count);
}
int MPI_Alltoall(const void* from, int count, MPI_Datatype type, void* to, int, MPI_Datatype, MPI_Comm) {
  return copy(from, to, type, count);
}
/// Nobody was sent to, so there is nothing to wait for.
int MPI_Waitall(int, MPI_Request*, MPI_Status*) {
  return MPI_SUCCESS;
}
int MPI_Testall(int, MPI_Request*, int* done, MPI_Status*) {
  return *done = 1, MPI_SUCCESS;
}
int MPI_Startall(int, MPI_Request*) {
  return MPI_SUCCESS;
}
double MPI_Wtime() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double MPI_Wtick() {
  return 1e-9;
}
int MPI_Abort(MPI_Comm, int code) {
  std::exit(code);
}

}  // extern "C"

[[noreturn]] static void never(const char* name) {
  std::fprintf(stderr, "dupin-multigrid: %s has no place in one process\n", name);
  std::abort();
}

// By their names in the object files alone: some are not declared anywhere here.
#define NEVER(name)                                       \
  extern "C" [[noreturn]] void never_##name() asm(#name); \
  extern "C" void never_##name() {                        \
    never(#name);                                         \
  }

// What has no semicolons would be laid out anew every time.
// clang-format off
NEVER(MPI_Init) NEVER(MPI_Finalize) NEVER(MPI_Allgatherv) NEVER(MPI_Gatherv) NEVER(MPI_Scatterv)
NEVER(MPI_Comm_f2c) NEVER(MPI_Comm_split) NEVER(MPI_Get_address) NEVER(MPI_Get_count) NEVER(MPI_Iprobe)
NEVER(MPI_Probe) NEVER(MPI_Irecv) NEVER(MPI_Irsend) NEVER(MPI_Isend) NEVER(MPI_Recv) NEVER(MPI_Recv_init)
NEVER(MPI_Send) NEVER(MPI_Send_init) NEVER(MPI_Request_free) NEVER(MPI_Op_create) NEVER(MPI_Op_free)
NEVER(MPI_Test) NEVER(MPI_Wait) NEVER(MPI_Waitany) NEVER(MPI_Type_commit) NEVER(MPI_Type_contiguous)
NEVER(MPI_Type_create_hvector) NEVER(MPI_Type_create_struct) NEVER(MPI_Type_free) NEVER(MPI_Type_vector)
// Direct solvers, of hypre's coarsest level and of its SuperLU smoother.
NEVER(daxpy_) NEVER(ddot_) NEVER(dgels_) NEVER(dgemv_) NEVER(dgetrf_) NEVER(dgetri_) NEVER(dgetrs_)
NEVER(dpotrf_) NEVER(dpotrs_) NEVER(dscal_) NEVER(PStatFree) NEVER(PStatInit)
NEVER(dCreate_CompRowLoc_Matrix_dist) NEVER(Destroy_CompRowLoc_Matrix_dist) NEVER(dDestroy_LU)
NEVER(dLUstructFree) NEVER(dLUstructInit) NEVER(dScalePermstructFree) NEVER(dScalePermstructInit)
NEVER(dSolveFinalize) NEVER(pdgssvx) NEVER(set_default_options_dist) NEVER(superlu_gridexit)
NEVER(superlu_gridinit)
    // clang-format on
