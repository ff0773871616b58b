// Loops over threads: every index once, and an exception that does not depend on the threads.
#include <doctest/doctest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "threads.hpp"

using namespace stokes;

TEST_CASE("a parallel loop calls every index once, and a loop inside another one runs on its thread") {
  std::vector<int> calls(1000);
  parallel_for(10, [&](long i) { parallel_for(100, [&](long j) { ++calls[100 * i + j]; }); });
  for (const int count : calls) CHECK(count == 1);
}

TEST_CASE("of several exceptions in a parallel loop that with the lowest index is thrown") {
  const int before = thread_count();
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    for (int trial = 0; trial < 20; ++trial) {
      std::string thrown;
      try {
        parallel_for(8, [](long i) {
          if (i == 0) return;
          // The lower the index, the later the exception.
          std::this_thread::sleep_for(std::chrono::milliseconds(8 - i));
          throw std::runtime_error(std::to_string(i));
        });
      } catch (const std::exception& error) {
        thrown = error.what();
      }
      CHECK(thrown == "1");
    }
  }
  set_thread_count(before);
}
