// Loops over threads whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <exception>
#include <mutex>

// The thread sanitizer sees what std::thread does, but not what OpenMP's threads wait for.
#ifdef STOKES_STD_THREADS
#include <atomic>
#include <thread>
#include <vector>
#elif defined(_OPENMP)
#include <omp.h>
#endif

namespace stokes {

// More than this is taken for an error of the user.
inline constexpr int most_threads = 1024;

namespace detail {

#ifdef STOKES_STD_THREADS
inline std::atomic<int> threads = 2;
inline thread_local bool is_in_parallel = false;
#endif

// Of all calls in a loop, the exception of the one with the lowest index: which it is does not depend on the threads.
class FirstException {
 public:
  void keep(long index) {
    const std::lock_guard lock(mutex_);
    if (error_ && index_ < index) return;
    index_ = index;
    error_ = std::current_exception();
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  long index_ = 0;
  std::exception_ptr error_;
};

}  // namespace detail

// Number of threads that parallel_for may use; 1 where OpenMP is missing.
inline int thread_count() {
#ifdef STOKES_STD_THREADS
  return detail::threads;
#elif defined(_OPENMP)
  return omp_get_max_threads();
#else
  return 1;
#endif
}

inline void set_thread_count([[maybe_unused]] int count) {
#ifdef STOKES_STD_THREADS
  detail::threads = count;
#elif defined(_OPENMP)
  omp_set_num_threads(count);
#endif
}

// Calls body(i) for i in [0, count), in any order and side by side. Each call must write only what no
// other call touches, which makes the result independent of the number of threads. Of the exceptions that calls throw
// that with the lowest index is rethrown here. Loops of one iteration, or inside another loop, run on the calling thread.
template <class Body>
void parallel_for(long count, const Body& body) {
#ifdef STOKES_STD_THREADS
  if (count > 1 && thread_count() > 1 && !detail::is_in_parallel) {
    detail::FirstException error;
    std::atomic<long> next = 0;
    std::vector<std::thread> team;
    for (long k = std::min<long>(count, thread_count()); k > 0; --k)
      team.emplace_back([&] {
        detail::is_in_parallel = true;
        for (long i; (i = next++) < count;) {
          try {
            body(i);
          } catch (...) {
            error.keep(i);
          }
        }
      });
    for (std::thread& thread : team) thread.join();
    return error.rethrow();
  }
#elif defined(_OPENMP)
  if (count > 1 && omp_get_max_threads() > 1 && !omp_in_parallel()) {
    detail::FirstException error;
#pragma omp parallel for schedule(dynamic, 1)
    for (long i = 0; i < count; ++i) {
      try {
        body(i);
      } catch (...) {
        error.keep(i);
      }
    }
    return error.rethrow();
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
