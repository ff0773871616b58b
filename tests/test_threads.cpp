// Loops over threads: every index once, an exception that does not depend on the threads, and idle threads that cost
// nothing.
#include <doctest/doctest.h>

#include <chrono>
#include <ctime>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "threads.hpp"

using namespace stokes;

namespace {

void sleep_milliseconds(int count) { std::this_thread::sleep_for(std::chrono::milliseconds(count)); }

// Sets the number of threads in a scope.
class Threads {
 public:
  explicit Threads(int count) { set_thread_count(count); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { set_thread_count(before_); }

 private:
  int before_ = thread_count();
};

// The number of threads that make the calls of a loop, each of which takes a millisecond.
std::size_t threads_used(long work) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallel_for_large(40, work, [&](long) {
    sleep_milliseconds(1);
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen.size();
}

}  // namespace

TEST_CASE("a parallel loop calls every index once, and a loop inside another one runs on its thread") {
  std::vector<int> calls(1000);
  parallel_for(10, [&](long i) { parallel_for(100, [&](long j) { ++calls[100 * i + j]; }); });
  for (const int count : calls) CHECK(count == 1);
}

TEST_CASE("of several exceptions in a parallel loop that with the lowest index is thrown") {
  for (const int threads : {1, 2, 4}) {
    const Threads scope(threads);
    for (int trial = 0; trial < 20; ++trial) {
      std::string thrown;
      try {
        parallel_for(8, [](long i) {
          if (i == 0) return;
          sleep_milliseconds(static_cast<int>(8 - i));  // the lower the index, the later the exception
          throw std::runtime_error(std::to_string(i));
        });
      } catch (const std::exception& error) {
        thrown = error.what();
      }
      CHECK(thrown == "1");
    }
  }
}

TEST_CASE("a loop uses no more threads than its work feeds") {
  const Threads scope(4);
  CHECK(threads_used(1999) == 1);
  CHECK(threads_used(2999) <= 2);
  CHECK(threads_used(3999) <= 3);
  CHECK(threads_used(100000) > 1);
}

TEST_CASE("threads that wait for the next loop sleep") {
  const Threads scope(4);
  const std::clock_t start = std::clock();
  for (int k = 0; k < 100; ++k) {
    parallel_for(4, [](long) {});
    sleep_milliseconds(1);
  }
  // Time of all threads together. Three threads that waited actively would take a good part of a millisecond each, .3 s in
  // all.
  CHECK(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 0.1);
}

TEST_CASE("loops of several threads at a time are done once each") {
  const Threads scope(3);
  std::vector<std::vector<int>> calls(3, std::vector<int>(500));
  std::vector<std::thread> callers;
  for (std::vector<int>& mine : calls)
    callers.emplace_back([&mine] {
      for (int k = 0; k < 20; ++k) parallel_for(500, [&mine](long i) { ++mine[i]; });
    });
  for (std::thread& caller : callers) caller.join();
  for (const std::vector<int>& each : calls) CHECK(each == std::vector<int>(500, 20));
}
