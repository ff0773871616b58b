// Loops over threads whose results do not depend on the number of threads.
#pragma once

#include <exception>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace stokes {

// More than this is taken for an error of the user.
inline constexpr int most_threads = 1024;

// Number of threads that parallel_for may use; 1 where OpenMP is missing.
inline int thread_count() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

inline void set_thread_count([[maybe_unused]] int count) {
#ifdef _OPENMP
  omp_set_num_threads(count);
#endif
}

// Calls body(i) for i in [0, count), in any order and side by side. Each call must write only what no
// other call touches, which makes the result independent of the number of threads. An exception thrown
// by a call is rethrown here. Loops of one iteration, or inside another loop, run on the calling thread.
template <class Body>
void parallel_for(long count, const Body& body) {
#ifdef _OPENMP
  if (count > 1 && omp_get_max_threads() > 1 && !omp_in_parallel()) {
    std::exception_ptr error;
#pragma omp parallel for schedule(dynamic, 1)
    for (long i = 0; i < count; ++i) {
      try {
        body(i);
      } catch (...) {
#pragma omp critical
        error = std::current_exception();
      }
    }
    if (error) std::rethrow_exception(error);
    return;
  }
#endif
  for (long i = 0; i < count; ++i) body(i);
}

// The same, on the calling thread where `work` (boundary nodes, say) is too little to share.
template <class Body>
void parallel_for_large(long count, long work, const Body& body) {
  constexpr long enough = 2000;
  if (work >= enough) return parallel_for(count, body);
  for (long i = 0; i < count; ++i) body(i);
}

}  // namespace stokes
