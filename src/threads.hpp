// Loops over threads whose results do not depend on the number of threads.
#pragma once

#include <functional>

namespace stokes {

// A larger number of threads is refused as a typing error.
inline constexpr int most_threads = 1024;

// Number of threads that a loop may use. The default is OMP_NUM_THREADS, which job scripts set, or else the number of
// cores available to this process.
int thread_count();
void set_thread_count(int count);

// Calls body(i) for i in [0, count) in parallel, in any order. Each call must write only what no other call touches. The
// result then does not depend on the number of threads. If several calls throw, the exception of the lowest index is
// rethrown here. Loops of one iteration and loops inside another loop run on the calling thread. Idle threads sleep. The
// calling thread waits only for calls that have begun: on a loaded machine it may make all of them itself.
void parallel_for(long count, const std::function<void(long)>& body);

// The same with at most one thread per thousand units of `work`, such as boundary nodes. A thousand nodes with tens of
// neighbours each are tens of thousands of pairs, which take ten times as long as waking a thread.
void parallel_for_large(long count, long work, const std::function<void(long)>& body);

}  // namespace stokes
