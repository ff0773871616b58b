// A vector register of doubles. Arithmetic on packs is element by element.
#pragma once

#include <cstddef>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#else
#include <cmath>
#endif

namespace stokes {

#if defined(__AVX512F__)
inline constexpr int lanes = 8;
#elif defined(__AVX__)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif

typedef double Pack __attribute__((vector_size(lanes * sizeof(double))));
typedef long long PackBits __attribute__((vector_size(lanes * sizeof(double))));

inline Pack load(const double* p) {
  Pack v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

inline void store(double* p, Pack v) { std::memcpy(p, &v, sizeof v); }

// Arrays that start at a cache line: packs at multiples of eight entries never straddle two lines, which
// halves the time of loops that are bound by their loads.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, alignment); }
  // New entries are left uninitialised: large arrays are first written by the threads that use them.
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
  }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
};
using AlignedVector = std::vector<double, CacheLineAllocator<double>>;

// All lanes equal.
inline Pack broadcast(double value) { return value - Pack{}; }

// The compiler does not vectorise std::sqrt, which may set errno.
inline Pack sqrt(Pack v) {
#if defined(__AVX512F__)
  return (Pack)_mm512_sqrt_pd((__m512d)v);
#elif defined(__AVX__)
  return (Pack)_mm256_sqrt_pd((__m256d)v);
#elif defined(__SSE2__)
  return (Pack)_mm_sqrt_pd((__m128d)v);
#else
  for (int i = 0; i < lanes; ++i) v[i] = std::sqrt(v[i]);
  return v;
#endif
}

inline PackBits sign_bits(Pack v) { return (PackBits)v & (PackBits)broadcast(-0.0); }
inline Pack absolute(Pack v) { return (Pack)((PackBits)v & ~(PackBits)broadcast(-0.0)); }
inline Pack flip_sign(Pack magnitude, PackBits sign) { return (Pack)((PackBits)magnitude ^ sign); }

// Keeps a loaded pack in a register. Otherwise g++ loads it again for each of its uses, which makes loops with
// several products of one load bound by the loads.
inline void keep_in_register([[maybe_unused]] Pack& v) {
#if defined(__AVX512F__)
  asm("" : "+v"(v));
#endif
}

// Calls body(0), ..., body(count - 1) with a constant index, so that arrays of packs indexed by it stay in registers.
template <int count, class Body>
inline void unrolled(const Body& body) {
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (body(std::integral_constant<int, i>{}), ...);
  }(std::make_integer_sequence<int, count>{});
}

namespace detail {

// Lane i: of a where bit `step` of i is 0, of b where it is 1, the sum of the two lanes that differ in
// that bit.
template <int step, int... i>
inline Pack fold(Pack a, Pack b, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(a, b, ((i & step ? lanes : 0) + (i & ~step))...) +
         __builtin_shufflevector(a, b, ((i & step ? lanes : 0) + (i | step))...);
}

template <int count>
inline Pack sum_of_lanes(const double* v) {
  if constexpr (count == 1) {
    return load(v);
  } else {
    constexpr int half = count / 2;
    return fold<half>(sum_of_lanes<half>(v), sum_of_lanes<half>(v + half * lanes),
                      std::make_integer_sequence<int, lanes>{});
  }
}

}  // namespace detail

// Lane i of the result is the sum over the lanes of pack i, for `lanes` packs one after the other.
inline Pack sum_of_lanes(const double* v) { return detail::sum_of_lanes<lanes>(v); }

struct ComplexPack {
  Pack re, im;
};

inline ComplexPack operator*(ComplexPack a, ComplexPack b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

inline ComplexPack operator*(double a, ComplexPack b) { return {a * b.re, a * b.im}; }
inline ComplexPack operator*(Pack a, ComplexPack b) { return {a * b.re, a * b.im}; }
inline ComplexPack operator+(ComplexPack a, ComplexPack b) { return {a.re + b.re, a.im + b.im}; }
inline ComplexPack operator-(ComplexPack a, ComplexPack b) { return {a.re - b.re, a.im - b.im}; }

inline ComplexPack conj(ComplexPack a) { return {a.re, -a.im}; }
inline Pack squared(ComplexPack a) { return a.re * a.re + a.im * a.im; }  // modulus

inline ComplexPack inverse(ComplexPack a) {
  const Pack factor = 1.0 / squared(a);
  return {a.re * factor, -a.im * factor};
}

// Natural logarithm of positive normal numbers, to 2 ulp (absolute 2e-16 near 1): with x = 2^e m,
// m in [1/sqrt 2, sqrt 2), log x = e log 2 + 2 artanh((m - 1)/(m + 1)), and the series of artanh.
inline Pack log(Pack x) {
  constexpr long long half_bits = 0x3fe6a09e667f3bcd;  // 1/sqrt 2
  const PackBits bits = (PackBits)x;
  const PackBits offset = bits - half_bits;
  const PackBits exponent = offset >> 52;  // of the factor that brings m into its interval
  const Pack m = (Pack)(bits - (exponent << 52));
  // Small integers as doubles without a conversion instruction: the low bits of 2^52 + 2^51.
  const Pack e = (Pack)(exponent + 0x4338000000000000) - 6755399441055744.0;
  const Pack s = (m - 1.0) / (m + 1.0), t = s * s;
  Pack series = broadcast(1.0 / 23.0);
  for (const int n : {21, 19, 17, 15, 13, 11, 9, 7, 5, 3}) series = series * t + 1.0 / n;
  return e * 0.693147180559945309417 + 2.0 * (s + s * t * series);
}

}  // namespace stokes
