/** @file jail.cpp
 * Runs a program that nobody has looked at:  jail [OPTION...] -- FILE [ARG...]
 * FILE can't open a file for writing, reach the network, start a process, end
 * another one or look into it. What is denied fails with EPERM; what the
 * sanitizers need stays. Time, memory and output are watched by the parent.
 *
 *   --cpu S      seconds of processor time
 *   --size B     bytes of the largest file; 0 if not given
 *   --memory B   bytes of address space; not for AddressSanitizer
 *   --read P     P and all below may be read; nothing else. May be repeated.
 *   --write P    as --read, and may be written (by a compiler)
 *   --compiler   FILE is a compiler: it may start processes and write
 *   --unsafe     without the filter of system calls
 *   --has        no program: says "landlock" if the kernel has it
 * --read and --write need Landlock and hold where the kernel has it.
 * If a part of the jail can't be made, FILE is not run: exit status 125. */
#include <fcntl.h>
#include <grp.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

constexpr int most_files = 64;   // open at once
constexpr int program_fd = 900;  // FILE; above what can be opened later
constexpr unsigned nobody = 65534;

struct Options {
  rlim_t cpu = 10, size = 0, memory = RLIM_INFINITY;
  std::vector<std::string> read, write;
  bool compiler = false, unsafe = false;
  char** command = nullptr;
};

[[noreturn]] void refuse(const std::string& what) {
  std::fprintf(stderr, "jail: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(125);
}
void need(bool ok, const std::string& what) {
  if (!ok) refuse(what);
}

Options options_of(char** arg) {
  Options o;
  for (++arg; *arg; ++arg) {
    const std::string word = *arg;
    if (word == "--compiler") {
      o.compiler = true;
    } else if (word == "--unsafe") {
      o.unsafe = true;
    } else if (word == "--has") {
      const bool there = syscall(SYS_landlock_create_ruleset, nullptr, 0,
                                 LANDLOCK_CREATE_RULESET_VERSION) > 0;
      std::puts(there ? "landlock" : "");
      std::exit(0);
    } else if (word == "--") {
      o.command = arg + 1;
      break;
    } else {
      errno = EINVAL;
      need(*++arg, word);
      if (word == "--read") {
        o.read.push_back(*arg);
      } else if (word == "--write") {
        o.write.push_back(*arg);
      } else if (word == "--cpu") {
        o.cpu = std::stoull(*arg);
      } else if (word == "--size") {
        o.size = std::stoull(*arg);
      } else if (word == "--memory") {
        o.memory = std::stoull(*arg);
      } else {
        refuse(word);
      }
    }
  }
  errno = EINVAL;
  need(o.command && *o.command, "no program");
  return o;
}

void limit(int what, rlim_t soft, rlim_t hard) {
  const rlimit l{soft, hard};
  need(setrlimit(static_cast<__rlimit_resource>(what), &l) == 0, "setrlimit");
}

void set_limits(const Options& o) {
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, o.cpu, o.cpu + 1);
  limit(RLIMIT_FSIZE, o.size, o.size);
  limit(RLIMIT_NOFILE, most_files, most_files);
  // The same depth of recursion everywhere.
  if (!o.compiler) limit(RLIMIT_STACK, 8 << 20, 8 << 20);
  if (o.memory != RLIM_INFINITY) limit(RLIMIT_AS, o.memory, o.memory);
}

// ---- Landlock: which files may be read

void allow_path(int rules, const std::string& path, __u64 access) {
  const int fd = open(path.c_str(), O_PATH | O_CLOEXEC);
  if (fd < 0) return;  // what is not there can't be read
  struct stat s {};
  need(fstat(fd, &s) == 0, path);
  if (!S_ISDIR(s.st_mode))
    access &= LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE |
              LANDLOCK_ACCESS_FS_EXECUTE;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = access;
  rule.parent_fd = fd;
  need(syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule,
               0) == 0,
       "landlock_add_rule " + path);
  close(fd);
}

void hide_files(const Options& o) {
  if (o.read.empty() && o.write.empty()) return;
  constexpr __u64 reading = LANDLOCK_ACCESS_FS_EXECUTE |
                            LANDLOCK_ACCESS_FS_READ_FILE |
                            LANDLOCK_ACCESS_FS_READ_DIR;
  // The first version of Landlock knows these; enough for a compiler.
  constexpr __u64 all = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
  landlock_ruleset_attr attr{};
  attr.handled_access_fs = all;
  const long rules = syscall(SYS_landlock_create_ruleset, &attr,
                             sizeof attr.handled_access_fs, 0);
  if (rules < 0) return;  // the kernel has none
  for (const std::string& path : o.read) allow_path(int(rules), path, reading);
  for (const std::string& path : o.write) allow_path(int(rules), path, all);
  need(syscall(SYS_landlock_restrict_self, rules, 0) == 0, "landlock");
  close(int(rules));
}

// ---- seccomp: which system calls may be made

using Filter = scmp_filter_ctx;

// A name that this kind of processor has not is no error.
void allow(Filter f, const char* name) {
  const int call = seccomp_syscall_resolve_name(name);
  if (call != __NR_SCMP_ERROR) seccomp_rule_add(f, SCMP_ACT_ALLOW, call, 0);
}
// If its argument number n, of which only the bits in mask count, is value.
void allow_if(Filter f, const char* name, unsigned n, scmp_datum_t value,
              scmp_datum_t mask = ~scmp_datum_t(0)) {
  const int call = seccomp_syscall_resolve_name(name);
  if (call != __NR_SCMP_ERROR)
    seccomp_rule_add(f, SCMP_ACT_ALLOW, call, 1,
                     scmp_arg_cmp{n, SCMP_CMP_MASKED_EQ, mask, value});
}

void fill_for_program(Filter f) {
  for (const char* name :
       {// what it has open
        "read", "readv", "pread64", "preadv", "write", "writev", "lseek",
        "close", "close_range", "dup", "dup2", "dup3", "pipe", "pipe2", "poll",
        "ppoll", "select", "pselect6", "fstat", "getdents64",
        // what is there
        "stat", "lstat", "newfstatat", "statx", "statfs", "fstatfs", "access",
        "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd",
        // memory
        "mmap", "mprotect", "munmap", "mremap", "madvise", "mincore", "brk",
        // signals to itself
        "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "rt_sigpending",
        "rt_sigtimedwait", "sigaltstack", "pause", "alarm", "setitimer",
        "getitimer", "restart_syscall",
        // who, when and where
        "getpid", "gettid", "getppid", "getpgrp", "getuid", "geteuid", "getgid",
        "getegid", "uname", "sysinfo", "getrlimit", "getrusage", "times",
        "time", "gettimeofday", "clock_gettime", "clock_getres", "nanosleep",
        "clock_nanosleep", "getrandom", "getcpu",
        // threads
        "futex", "set_robust_list", "get_robust_list", "set_tid_address",
        "rseq", "arch_prctl", "sched_yield", "sched_getaffinity", "membarrier",
        "exit", "exit_group"})
    allow(f, name);

  constexpr unsigned writing =
      O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
  allow_if(f, "open", 1, O_RDONLY, writing);
  allow_if(f, "openat", 2, O_RDONLY, writing);
  // A descriptor above the limit: closed by the call, and never had again.
  allow_if(f, "execveat", 0, program_fd);
  allow_if(f, "clone", 0, CLONE_THREAD, CLONE_THREAD);
  const auto self = scmp_datum_t(getpid());
  allow_if(f, "kill", 0, self);
  allow_if(f, "tgkill", 0, self);
  allow_if(f, "prlimit64", 2, 0);  // to read a limit
  allow_if(f, "ioctl", 1, TCGETS);
  for (int command : {F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD, F_SETFD, F_GETFL})
    allow_if(f, "fcntl", 1, scmp_datum_t(command));
  for (int command : {PR_SET_NAME, PR_GET_NAME, PR_GET_DUMPABLE})
    allow_if(f, "prctl", 0, scmp_datum_t(command));
  // The C library then takes clone() and openat().
  for (const char* name : {"clone3", "openat2"})
    seccomp_rule_add(f, SCMP_ACT_ERRNO(ENOSYS),
                     seccomp_syscall_resolve_name(name), 0);
}

void filter_calls(const Options& o) {
  Filter f = seccomp_init(o.compiler ? SCMP_ACT_ALLOW : SCMP_ACT_ERRNO(EPERM));
  errno = ENOMEM;
  need(f, "seccomp");
  if (o.compiler) {
    for (const char* name : {"socket", "io_uring_setup", "ptrace"})
      seccomp_rule_add(f, SCMP_ACT_ERRNO(EPERM),
                       seccomp_syscall_resolve_name(name), 0);
  } else {
    fill_for_program(f);
  }
  errno = -seccomp_load(f);
  need(errno == 0, "the kernel refuses a filter of system calls");
  seccomp_release(f);
}

}  // namespace

int main(int, char** argv) {
  const Options o = options_of(argv);
  // Where the program stands does not depend on chance.
  personality(ADDR_NO_RANDOMIZE);
  const int file = open(o.command[0], O_RDONLY | O_CLOEXEC);
  need(file >= 0, o.command[0]);
  need(dup3(file, program_fd, O_CLOEXEC) == program_fd, "dup3");
  close(file);
  need(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0, "no_new_privs");
  hide_files(o);
  set_limits(o);
  if (geteuid() == 0 && !o.compiler)  // root could read all
    need(setgroups(0, nullptr) == 0 && setgid(nobody) == 0 &&
             setuid(nobody) == 0,
         "setuid");
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (!o.unsafe) filter_calls(o);
  syscall(SYS_execveat, program_fd, "", o.command, environ, AT_EMPTY_PATH);
  refuse(o.command[0]);
}
