#include "threads.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

namespace stokes {

namespace {

thread_local bool is_in_loop = false;

int core_count() {
#ifdef __linux__
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return CPU_COUNT(&cores);
#endif
  return static_cast<int>(std::thread::hardware_concurrency());
}

int initial_count() {
  const char* text = std::getenv("OMP_NUM_THREADS");
  const long asked = text ? std::strtol(text, nullptr, 10) : 0;
  return static_cast<int>(std::clamp<long>(asked >= 1 ? asked : core_count(), 1, most_threads));
}

std::atomic<int>& count_of_threads() {
  static std::atomic<int> count = initial_count();
  return count;
}

// Indices handed out one by one, and the exception of the lowest index. Which exception this is does not depend
// on the threads.
class Loop {
 public:
  Loop(long count, const std::function<void(long)>& body) : count_(count), body_(body) {}

  void run() {
    for (long i; (i = next_++) < count_;) {
      try {
        body_(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_ || i < index_) index_ = i, error_ = std::current_exception();
      }
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  long count_;
  const std::function<void(long)>& body_;
  std::atomic<long> next_ = 0;
  std::mutex mutex_;
  long index_ = 0;
  std::exception_ptr error_;
};

// Loops often follow each other within microseconds, while waking up takes tens of them. A thread therefore yields its core
// a number of times before it sleeps.
template <class Condition>
void linger_until(const Condition& is_met) {
  for (int k = 0; k < 100 && !is_met(); ++k) std::this_thread::yield();
}

// Threads that sleep until there is a loop to share.
class Team {
 public:
  Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  // Runs the loop on the calling thread and on at most `helpers` others.
  void share(Loop& loop, int helpers) {
    const std::unique_lock turn(turn_, std::try_to_lock);
    if (!turn) return loop.run();  // the team is in a loop of another thread
    {
      const std::lock_guard lock(mutex_);
      grow(helpers);
      loop_ = &loop;
      wanted_ = std::min(helpers, static_cast<int>(threads_.size()));
      for (int k = 0; k < wanted_; ++k) wake_.notify_one();
    }
    is_in_loop = true;
    loop.run();
    is_in_loop = false;
    const auto is_done = [this] { return running_ == 0; };
    std::unique_lock lock(mutex_);
    wanted_ = 0;  // nothing is left for those that have not begun
    lock.unlock();
    linger_until(is_done);
    lock.lock();
    done_.wait(lock, is_done);
  }

 private:
  void grow(int helpers) {
    try {
      while (static_cast<int>(threads_.size()) < helpers) threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {  // the system allows no more threads: the existing ones do the work
    }
  }

  void serve() {
    is_in_loop = true;
    const auto is_called = [this] { return wanted_ > 0 || is_ending_; };
    while (true) {
      linger_until(is_called);
      std::unique_lock lock(mutex_);
      wake_.wait(lock, is_called);
      if (is_ending_) return;
      --wanted_, ++running_;
      Loop& loop = *loop_;
      lock.unlock();
      loop.run();
      lock.lock();
      if (--running_ == 0) done_.notify_one();
    }
  }

  std::mutex turn_;   // held by the thread whose loop is shared
  std::mutex mutex_;  // held to change any member below
  std::condition_variable wake_, done_;
  std::vector<std::thread> threads_;
  Loop* loop_ = nullptr;
  std::atomic<int> wanted_ = 0, running_ = 0;  // threads that may still join the loop, and that are in it
  std::atomic<bool> is_ending_ = false;
};

void run_loop(long count, long threads, const std::function<void(long)>& body) {
  const long used = std::min({count, threads, static_cast<long>(thread_count())});
  if (used <= 1 || is_in_loop) {
    for (long i = 0; i < count; ++i) body(i);
    return;
  }
  static Team team;
  Loop loop(count, body);
  team.share(loop, static_cast<int>(used) - 1);
  loop.rethrow();
}

}  // namespace

int thread_count() { return count_of_threads(); }
void set_thread_count(int count) { count_of_threads() = count; }

void parallel_for(long count, const std::function<void(long)>& body) { run_loop(count, most_threads, body); }

void parallel_for_large(long count, long work, const std::function<void(long)>& body) {
  constexpr long work_of_a_thread = 1000;
  run_loop(count, work / work_of_a_thread, body);
}

}  // namespace stokes
