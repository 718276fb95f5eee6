#pragma once
// Three components of any scalar: doubles, or several of them at once.
namespace elamin {

/// a b + c; several doubles at once may round only once, see Lanes.
inline double multiply_add(double a, double b, double c) { return a * b + c; }

template <class T>
struct Triple {
  T x, y, z;
};

template <class T> Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> Triple<T> operator*(const T& s, const Triple<T>& a) { return {s * a.x, s * a.y, s * a.z}; }
/// s a + b.
template <class T> Triple<T> multiply_add(const T& s, const Triple<T>& a, const Triple<T>& b) {
  return {multiply_add(s, a.x, b.x), multiply_add(s, a.y, b.y), multiply_add(s, a.z, b.z)};
}
template <class T> T dot(const Triple<T>& a, const Triple<T>& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace elamin
