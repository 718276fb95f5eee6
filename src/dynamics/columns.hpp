#pragma once
// A vector for every particle in the two layouts that moving needs.
#include "core/archive.hpp"
#include "core/types.hpp"
#include "dynamics/lanes.hpp"

#include <new>
#include <vector>

namespace elamin {

inline Vec3 vector(const Triple<double>& a) { return {a.x, a.y, a.z}; }
inline Triple<double> triple(const Vec3& a) { return {a[0], a[1], a[2]}; }

/// Places for n particles in blocks of four, and some zeros behind them that may be read.
inline int padded(int n) { return (n + 3) / 4 * 4 + 8; }

/// Begins where four doubles of a row do not lie across two lines of the cache.
template <class T>
struct Aligned {
  using value_type = T;
  Aligned() = default;
  template <class U> Aligned(const Aligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t{64}); }
  bool operator==(const Aligned&) const { return true; }
};
using Column = std::vector<double, Aligned<double>>;

/// Component by component: four particles in a row are three loads.
struct Columns {
  Column x, y, z;

  Columns() = default;
  explicit Columns(int n) : x(padded(n)), y(padded(n)), z(padded(n)) {}
  explicit Columns(const Field& f) : Columns(static_cast<int>(f.cols())) {
    for (Eigen::Index i = 0; i < f.cols(); ++i) x[i] = f(0, i), y[i] = f(1, i), z[i] = f(2, i);
  }
  Triple<Lanes> load(int i) const { return {Lanes::load(&x[i]), Lanes::load(&y[i]), Lanes::load(&z[i])}; }
  void store(int i, const Triple<Lanes>& a) { a.x.store(&x[i]), a.y.store(&y[i]), a.z.store(&z[i]); }
  Vec3 at(int i) const { return {x[i], y[i], z[i]}; }
  double& at(int coordinate, int i) { return (coordinate == 0 ? x : coordinate == 1 ? y : z)[i]; }
  void carry(Archive& archive) { archive(x, y, z); }
  void copy_to(Field& f) const {
    for (Eigen::Index i = 0; i < f.cols(); ++i) f.col(i) << x[i], y[i], z[i];
  }
};

/// Particle by particle, (x, y, z, ·): any particle is one load.
struct Rows {
  std::vector<Lanes, Aligned<Lanes>> row;

  Rows() = default;
  explicit Rows(int n) : row(padded(n), Lanes(0.0)) {}
  Triple<Lanes> load(int i) const { return columns_of(row[i], row[i + 1], row[i + 2], row[i + 3]); }
  void store(int i, const Triple<Lanes>& a) {
    Lanes p = a.x, q = a.y, r = a.z, s(0.0);
    transpose(p, q, r, s);
    row[i] = p, row[i + 1] = q, row[i + 2] = r, row[i + 3] = s;
  }
  Triple<double> at(int i) const { return {row[i][0], row[i][1], row[i][2]}; }
  void add(int i, const Triple<double>& a) { row[i] += Lanes(a.x, a.y, a.z, 0); }
  void carry(Archive& archive) {
    for (Lanes& l : row)
      for (int k = 0; k < Lanes::count; ++k) {
        double number = l[k];
        archive(number);
        l.v[k] = number;
      }
  }
  void clear() { std::fill(row.begin(), row.end(), Lanes(0.0)); }
};

}  // namespace elamin
