// dupin-multigrid: the process in which hypre's BoomerAMG runs. Not for calling by hand: it answers matrices
// with prolongations (multigrid_protocol.h) through descriptor 3 until that is closed.
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <_hypre_parcsr_ls.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "../amg/multigrid.h"
#include "../amg/multigrid_protocol.h"

namespace dupin::amg {
namespace {

bool read_all(void* to, std::size_t bytes) {
  for (auto* at = static_cast<char*>(to); bytes > 0;) {
    const ssize_t n = ::read(kMultigridSocket, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

bool write_all(const void* from, std::size_t bytes) {
  for (auto* at = static_cast<const char*>(from); bytes > 0;) {
    const ssize_t n = ::write(kMultigridSocket, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

struct Matrix {
  MatrixHeader header;
  std::vector<HYPRE_Int> starts, columns;
  std::vector<double> values;
};

template <class T>
bool read_array(std::vector<T>& to, std::size_t count) {
  to.resize(count);
  return read_all(to.data(), count * sizeof(T));
}

bool read_matrix(Matrix& m) {
  return read_all(&m.header, sizeof m.header) && m.header.magic == kMultigridMagic &&
         m.header.entries <= kMostEntries && read_array(m.starts, std::size_t{m.header.rows} + 1) &&
         read_array(m.columns, m.header.entries) && read_array(m.values, m.header.entries);
}

HYPRE_IJMatrix to_hypre(Matrix& m) {
  const auto rows = static_cast<HYPRE_Int>(m.header.rows);
  HYPRE_IJMatrix matrix;
  HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, rows - 1, 0, rows - 1, &matrix);
  HYPRE_IJMatrixSetObjectType(matrix, HYPRE_PARCSR);
  std::vector<HYPRE_Int> counts(m.header.rows), numbers(m.header.rows);
  std::iota(numbers.begin(), numbers.end(), 0);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = m.starts[i + 1] - m.starts[i];
  HYPRE_IJMatrixSetRowSizes(matrix, counts.data());
  HYPRE_IJMatrixInitialize(matrix);
  HYPRE_IJMatrixSetValues(matrix, rows, counts.data(), numbers.data(), m.columns.data(), m.values.data());
  HYPRE_IJMatrixAssemble(matrix);
  return matrix;
}

/// BoomerAMG's set-up of one level as far as its prolongation, from hypre's own stages: the coarse matrix that
/// HYPRE_BoomerAMGSetup would go on with is not asked for. Null where every point, or none, is a coarse one.
hypre_ParCSRMatrix* prolongation_of(hypre_ParCSRMatrix* a) {
  static_assert(kCoarsening == 6 && kInterpolation == 0, "the stages called below");
  const HYPRE_Int rows = hypre_CSRMatrixNumRows(hypre_ParCSRMatrixDiag(a));
  hypre_ParCSRMatrix *strong = nullptr, *p = nullptr;
  hypre_IntArray *coarse = nullptr, *functions = nullptr;
  HYPRE_BigInt range[2] = {0, 0};
  hypre_BoomerAMGCreateS(a, kStrongThreshold, 1, 1, nullptr, &strong);
  hypre_BoomerAMGCoarsenFalgout(strong, a, 0, 0, 0, &coarse);
  hypre_BoomerAMGCoarseParms(MPI_COMM_SELF, rows, 1, nullptr, coarse, &functions, range);
  if (range[1] > 0 && range[1] < rows)
    hypre_BoomerAMGBuildInterp(a, hypre_IntArrayData(coarse), strong, range, 1, nullptr, 0, 0,
                               kMostInterpolation, &p);
  hypre_ParCSRMatrixDestroy(strong);
  hypre_IntArrayDestroy(coarse);
  return p;
}

bool answer(hypre_ParCSRMatrix* prolongation, std::uint32_t rows) {
  MatrixHeader header;
  header.rows = rows;
  if (!prolongation) {
    const std::vector<HYPRE_Int> none(std::size_t{rows} + 1);
    return write_all(&header, sizeof header) && write_all(none.data(), none.size() * sizeof none[0]);
  }
  const hypre_CSRMatrix* p = hypre_ParCSRMatrixDiag(prolongation);
  header.columns = static_cast<std::uint32_t>(hypre_CSRMatrixNumCols(p));
  header.entries = static_cast<std::uint32_t>(hypre_CSRMatrixI(p)[rows]);
  return write_all(&header, sizeof header) &&
         write_all(hypre_CSRMatrixI(p), (std::size_t{rows} + 1) * sizeof(HYPRE_Int)) &&
         write_all(hypre_CSRMatrixJ(p), header.entries * sizeof(HYPRE_Int)) &&
         write_all(hypre_CSRMatrixData(p), header.entries * sizeof(double));
}

bool serve_one() {
  Matrix m;
  if (!read_matrix(m)) return false;
  const HYPRE_IJMatrix matrix = to_hypre(m);
  HYPRE_ParCSRMatrix rows;
  HYPRE_IJMatrixGetObject(matrix, reinterpret_cast<void**>(&rows));
  hypre_ParCSRMatrix* prolongation = prolongation_of(rows);
  const bool sent = answer(prolongation, m.header.rows);
  hypre_ParCSRMatrixDestroy(prolongation);
  HYPRE_IJMatrixDestroy(matrix);
  return sent;
}

}  // namespace
}  // namespace dupin::amg

int main() {
  static_assert(sizeof(HYPRE_Int) == 4, "the protocol's integers are hypre's");
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it does not outlive whom it works for
  ::signal(SIGPIPE, SIG_IGN);
  HYPRE_Init();
  while (dupin::amg::serve_one()) {
  }
  return 0;
}
