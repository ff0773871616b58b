// Runs every test case: a line for each file, failures where they happen, and a last line `N passed, N failed`. With
// VERBOSE=1 in the environment the tests also print what they measure.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

doctest::TestRunStats totals;

bool is_verbose() {
  const char* value = std::getenv("VERBOSE");
  return value && *value;
}

class Brief : public doctest::ConsoleReporter {
 public:
  explicit Brief(const doctest::ContextOptions& options) : ConsoleReporter(options) {}

  void test_run_start() override {}
  void test_case_start(const doctest::TestCaseData& test) override {
    if (file_ != test.m_file.c_str()) end_file();
    file_ = test.m_file.c_str();
    ConsoleReporter::test_case_start(test);
  }
  void test_case_end(const doctest::CurrentTestCaseStats& test) override {
    ConsoleReporter::test_case_end(test);
    ++(test.testCaseSuccess ? passed_ : failed_);
  }
  void log_message(const doctest::MessageData& message) override {
    if (is_verbose() || message.m_severity != doctest::assertType::is_warn) ConsoleReporter::log_message(message);
  }
  void test_run_end(const doctest::TestRunStats& run) override {
    end_file();
    totals = run;
  }

 private:
  void end_file() {
    if (passed_ + failed_ > 0) s << file_ << ": " << passed_ << " passed, " << failed_ << " failed" << std::endl;
    passed_ = failed_ = 0;
  }

  std::string file_;
  int passed_ = 0, failed_ = 0;
};
REGISTER_REPORTER("brief", 1, Brief);

}  // namespace

int main(int argc, char** argv) {
  doctest::Context context;
  context.setOption("reporters", "brief");
  context.applyCommandLine(argc, argv);
  const int status = context.run();
  if (context.shouldExit()) return status;  // a query such as --list-test-cases
  const unsigned failed = totals.numTestCasesFailed;
  std::printf("%u passed, %u failed\n", totals.numTestCasesPassingFilters - failed, failed);
  return status;
}
