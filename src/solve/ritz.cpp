#include "solve/ritz.hpp"

namespace elamin {

Eigen::MatrixXd starting_block(int rows, int columns) {
  Eigen::MatrixXd x(rows, columns);
  std::uint64_t s = 0x9E3779B97F4A7C15ull;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    s ^= s << 13, s ^= s >> 7, s ^= s << 17;                       // xorshift64 (Marsaglia 2003)
    x.data()[i] = static_cast<double>(s >> 11) / 9007199254740992.0 - 0.5;
  }
  return x;
}

Vector rotate_to_ritz(const Energy& energy, Eigen::MatrixXd& x) {
  Eigen::MatrixXd hx(x.rows(), x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) hx.col(j) = energy.multiply(x.col(j));
  const Eigen::MatrixXd projected = x.transpose() * hx;
  const EigenPairs small = symmetric_eigen((projected + projected.transpose()) / 2);
  x = x * small.vectors;
  return small.values;
}

}  // namespace elamin
