#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace rubble::slam {

/// What a guarded process is given. All descriptors close on exec.
struct GuardedProcess {
  std::vector<std::string> argv;  ///< argv[0] is a path
  int input = -1;                 ///< becomes its standard input
  int output = -1;                ///< becomes its standard output
  int errors = -1;                ///< becomes its standard error; -1: ours
};

/// Starts a process that does not outlive this one, however this one ends (kill -9 too), nor leaves processes of its
/// own behind. Between the two stands a guardian: a fork that holds one end of a socket, adopts what the process leaves
/// (it is their subreaper), and ends all of them when the process ends or the other end of the socket, `lifeline`,
/// closes. It has one thread and lives as long as its charge, so that "die with your parent" means what it says.
/// Once the process has ended, its status as of waitpid can be read from the lifeline (an int).
/// Returns the guardian's process id, to be waited for after closing the lifeline. Throws RunError.
pid_t start_guarded(const GuardedProcess& process, int& lifeline);

}  // namespace rubble::slam
