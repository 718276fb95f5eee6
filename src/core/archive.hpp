#pragma once
// What a run carries from one point to the next, to the bit.
#include "core/error.hpp"
#include "core/types.hpp"

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace elamin {

namespace detail {

struct AnyMember {
  template <class T> operator T&() const;
};

/// How many members a plain struct has: the most that it can be made of, each of any type.
template <class T, std::size_t n = 16> consteval std::size_t members() {
  constexpr auto takes = []<std::size_t... i>(std::index_sequence<i...>) { return requires { T{(void(i), AnyMember())...}; }; };
  if constexpr (takes(std::make_index_sequence<n>())) return n;
  else return members<T, n - 1>();
}

}  // namespace detail

/// Bytes of this machine, in the order in which they are called for. One list of parts, `archive(a, b, c)`, both writes them and reads them back:
/// numbers, texts, containers, Eigen's matrices, what has a member `carry(Archive&)`, and plain structs, of which no member is forgotten. Throws InputError
/// where reading comes to the end of the bytes.
class Archive {
 public:
  Archive() = default;                                                       // writes
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}

  bool reads() const { return reads_; }
  const std::string& bytes() const { return bytes_; }
  /// What has not been read yet.
  std::string_view rest() const { return std::string_view(bytes_).substr(at_); }

  template <class... Parts> void operator()(Parts&... parts) { (part(parts), ...); }

 private:
  void raw(void* data, std::size_t size) {
    if (!reads_) return void(bytes_.append(static_cast<const char*>(data), size));
    if (size > bytes_.size() - at_) throw InputError("the checkpoint is not whole");
    at_ += bytes_.copy(static_cast<char*>(data), size, at_);
  }
  std::size_t count(std::size_t now) {
    std::uint64_t n = now;
    raw(&n, sizeof n);
    if (reads_ && n > bytes_.size()) throw InputError("the checkpoint is not whole");
    return static_cast<std::size_t>(n);
  }

  template <class T> void part(T& x) {
    if constexpr (requires { x.carry(*this); }) x.carry(*this);
    else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) raw(&x, sizeof x);
    else if constexpr (std::is_base_of_v<Eigen::PlainObjectBase<T>, T>) matrix(x);
    else if constexpr (std::is_base_of_v<Eigen::QuaternionBase<T>, T>) matrix(x.coeffs());
    else plain<detail::members<T>()>(x);
  }
  template <std::size_t n, class T> void plain(T& x) {
    if constexpr (n == 2) {
      auto& [a, b] = x;
      (*this)(a, b);
    } else if constexpr (n == 3) {
      auto& [a, b, c] = x;
      (*this)(a, b, c);
    } else if constexpr (n == 4) {
      auto& [a, b, c, d] = x;
      (*this)(a, b, c, d);
    } else if constexpr (n == 5) {
      auto& [a, b, c, d, e] = x;
      (*this)(a, b, c, d, e);
    } else if constexpr (n == 6) {
      auto& [a, b, c, d, e, f] = x;
      (*this)(a, b, c, d, e, f);
    } else if constexpr (n == 7) {
      auto& [a, b, c, d, e, f, g] = x;
      (*this)(a, b, c, d, e, f, g);
    } else if constexpr (n == 8) {
      auto& [a, b, c, d, e, f, g, h] = x;
      (*this)(a, b, c, d, e, f, g, h);
    } else if constexpr (n == 9) {
      auto& [a, b, c, d, e, f, g, h, i] = x;
      (*this)(a, b, c, d, e, f, g, h, i);
    } else if constexpr (n == 11) {
      auto& [a, b, c, d, e, f, g, h, i, j, k] = x;
      (*this)(a, b, c, d, e, f, g, h, i, j, k);
    } else if constexpr (n == 12) {
      auto& [a, b, c, d, e, f, g, h, i, j, k, l] = x;
      (*this)(a, b, c, d, e, f, g, h, i, j, k, l);
    } else if constexpr (n == 13) {
      auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = x;
      (*this)(a, b, c, d, e, f, g, h, i, j, k, l, m);
    } else {
      static_assert(n == 15, "a struct of as many members has no line here");
      auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = x;
      (*this)(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p);
    }
  }
  template <class M> void matrix(M& m) {
    Eigen::Index rows = m.rows(), columns = m.cols();
    raw(&rows, sizeof rows), raw(&columns, sizeof columns);
    if (reads_) {
      if (rows < 0 || columns < 0 || (rows > 0 && columns > static_cast<Eigen::Index>(bytes_.size()) / rows)) throw InputError("the checkpoint is not whole");
      m.resize(rows, columns);
    }
    raw(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename M::Scalar));
  }
  void part(std::string& text) {
    text.resize(count(text.size()));
    raw(text.data(), text.size());
  }
  template <class T, class A> void part(std::vector<T, A>& list) {
    list.resize(count(list.size()));
    if constexpr (std::is_arithmetic_v<T>) raw(list.data(), list.size() * sizeof(T));
    else
      for (T& x : list) part(x);
  }
  template <class T> void part(std::deque<T>& list) {
    list.resize(count(list.size()));
    for (T& x : list) part(x);
  }
  template <class T, std::size_t n> void part(std::array<T, n>& list) {
    for (T& x : list) part(x);
  }
  template <class A, class B> void part(std::pair<A, B>& x) { part(x.first), part(x.second); }
  template <class T> void part(std::optional<T>& x) {
    bool there = x.has_value();
    part(there);
    if (reads_) there ? void(x.emplace()) : x.reset();
    if (there) part(*x);
  }
  template <class T> void part(std::set<T>& set) {
    std::vector<T> list(set.begin(), set.end());
    part(list);
    if (reads_) set = std::set<T>(list.begin(), list.end());
  }
  template <class K, class V> void part(std::map<K, V>& map) {
    std::vector<std::pair<K, V>> list(map.begin(), map.end());
    part(list);
    if (reads_) map = std::map<K, V>(list.begin(), list.end());
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reads_ = false;
};

}  // namespace elamin
