// Loops over threads whose results do not depend on the number of threads.
#pragma once

#include <functional>

namespace stokes {

// More than this is taken for an error of the user.
inline constexpr int most_threads = 1024;

// Number of threads that a loop may use. At first it is OMP_NUM_THREADS of the environment, as job scripts set it, and
// the number of cores that this process may use where that is not set.
int thread_count();
void set_thread_count(int count);

// Calls body(i) for i in [0, count), in any order and side by side. Each call must write only what no
// other call touches, which makes the result independent of the number of threads. Of the exceptions that calls throw
// that with the lowest index is rethrown here. Loops of one iteration, or inside another loop, run on the calling thread.
// Idle threads sleep. The calling thread waits only for calls that have begun: on a loaded machine it makes all of them.
void parallel_for(long count, const std::function<void(long)>& body);

// The same, with no more threads than `work` (boundary nodes, say) feeds: a thousand for each thread. A node takes the sum
// over some tens of others, which makes tens of thousands of pairs, ten times what it costs to wake a thread.
void parallel_for_large(long count, long work, const std::function<void(long)>& body);

}  // namespace stokes
