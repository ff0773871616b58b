// A checkpoint names its program and is on disk, as seen from the calls of the operating system.
#include <doctest/doctest.h>

#include "checkpoint.hpp"
#include "running_program.hpp"
#include "version.hpp"

#ifdef __linux__
#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

using namespace stokes;

namespace {

namespace fs = std::filesystem;

const std::string discs = "a,b,x,y,theta\n.5,.5,-1.3,.25,0\n.5,.5,0,0,0.1\n";

#ifdef __linux__
// Runs simulate with case.txt in a folder and returns its calls of fsync (f) and of rename (r), in order; empty if
// a process may not be traced.
std::string calls(const fs::path& folder) {
  const std::string program = simulate_program().string();
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (chdir(folder.c_str()) != 0 || nowhere < 0 || ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(99);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execl(program.c_str(), program.c_str(), "case.txt", "threads=1", "checkpoint_every=1e-9", nullptr);
    _exit(99);
  }
  std::string seen;
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) return {};
  ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  for (long pass_on = 0;;) {
    if (ptrace(PTRACE_SYSCALL, child, nullptr, pass_on) != 0 || waitpid(child, &status, 0) != child) return {};
    if (!WIFSTOPPED(status)) return seen;
    const int signal = WSTOPSIG(status);
    const bool is_call = signal == (SIGTRAP | 0x80);
    pass_on = is_call ? 0 : signal;
    __ptrace_syscall_info info{};
    if (!is_call || ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0) continue;
    if (info.op != PTRACE_SYSCALL_INFO_ENTRY) continue;
    if (info.entry.nr == SYS_fsync) seen += 'f';
#ifdef SYS_rename
    if (info.entry.nr == SYS_rename) seen += 'r';
#endif
    if (info.entry.nr == SYS_renameat || info.entry.nr == SYS_renameat2) seen += 'r';
  }
}
#endif

}  // namespace

#ifdef __linux__
TEST_CASE("a checkpoint is on disk before it takes its name, after the rows that it belongs to") {
  const Workspace here(case_text("shear", 16, 0.1, 0.3), discs);
  const std::string seen = calls(here.path());
  if (seen.empty()) return;  // where tracing is not allowed
  CAPTURE(seen);
  int checkpoints = 0;  // both tables, the new file, its name, the folder
  for (std::size_t at = 0; (at = seen.find("fffrf", at)) != std::string::npos; at += 5) ++checkpoints;
  CHECK(checkpoints == 3);
}
#endif

TEST_CASE("a checkpoint of another build of the program is continued with a warning that names both") {
  const Workspace here(case_text("shear", 64, 0.01, 5), discs);
  REQUIRE(stopped(here, SIGTERM, {"case.txt"}).status == 143);
  std::string text = content_of(here.path() / "out/checkpoint");
  const std::size_t build = text.find(build_description());
  REQUIRE(build != std::string::npos);
  text.replace(build, build_description().size(), "version 0.0.9, cc 3, PDP-11 instructions");
  const std::size_t sum = text.rfind("checksum ");
  text = concat(text.substr(0, sum), "checksum ", std::to_string(checksum(text.substr(0, sum))), "\n");
  here.write("out/checkpoint", text);
  const ProgramRun run = here.run({"case.txt"});
  CAPTURE(run.errors);
  CHECK(run.status == 0);
  CHECK(run.errors.find("going on from step ") != std::string::npos);
  CHECK(run.errors.find(concat("of another build of the program (version 0.0.9, cc 3, PDP-11 instructions; this is ",
                               build_description(), ")")) != std::string::npos);
}
