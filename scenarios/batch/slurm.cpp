#include "scenarios/batch/slurm.h"

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/text/text_file.h"
#include "scenarios/batch/batch.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

std::string sbatch_line(const std::string& option) { return "#SBATCH " + option + "\n"; }

/// sbatch's own lines know double quotes, not the shell's.
std::string sbatch_word(const std::string& text) {
  if (text.find('"') != std::string::npos || text.find('\n') != std::string::npos)
    throw InputError(text + ": a path with a quote or a line break cannot be given to sbatch; use another folder");
  return text.find_first_of(" \t") == std::string::npos ? text : "\"" + text + "\"";
}

std::string environment(const SlurmPlan& plan) {
  return "set -euo pipefail\n" + (plan.home.empty() ? "" : "export RUBBLE_HOME=" + shell_word(plan.home) + "\n");
}

struct Said {
  int code = 0;
  std::string text;
};

Said run(const std::string& command) {
  Said said;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw RunError("sbatch: cannot be started");
  char buffer[512];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) said.text += buffer;
  const int status = pclose(pipe);
  said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  while (!said.text.empty() && said.text.back() == '\n') said.text.pop_back();
  return said;
}

/// `sbatch --parsable` prints "id" or "id;cluster".
std::string submit(const std::string& arguments) {
  const Said said = run("sbatch --parsable " + arguments);
  if (said.code == 127)
    throw RunError(
        "sbatch: is not installed here; submit on a login node, or make the shards by hand with --shard i/N");
  std::string text = said.text;
  for (char& c : text)
    if (c == '\n') c = ' ';
  if (said.code != 0 || text.find_first_of("0123456789") != 0)
    throw RunError("sbatch: " + text + "; the scripts are written, adapt them or give --slurm-option");
  return text.substr(0, text.find(';'));
}

}  // namespace

std::string shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

SlurmScripts slurm_scripts(const SlurmPlan& plan) {
  const std::string logs = plan.out + "/slurm/";
  std::string array = "#!/bin/bash\n" + sbatch_line("--job-name=" + sbatch_word("rubble-" + plan.name)) +
                      sbatch_line("--array=1-" + std::to_string(plan.shards)) +
                      sbatch_line("--cpus-per-task=" + std::to_string(plan.workers)) +
                      sbatch_line("--output=" + sbatch_word(logs + "shard-%a.log"));
  for (const auto& option : plan.options) array += sbatch_line(sbatch_word(option));
  array += environment(plan) + "exec " + shell_word(plan.program) + " batch " + shell_word(plan.sweep) + " --out " +
           shell_word(plan.out) + " --workers " + std::to_string(plan.workers);
  if (plan.record) array += " --record";
  if (plan.retry) array += " --retry";
  if (plan.allow_commands) array += " --allow-commands";
  for (const Override& o : plan.overrides) array += " --set " + shell_word(o.key + "=" + o.value);
  array += " --shard \"$SLURM_ARRAY_TASK_ID/" + std::to_string(plan.shards) + "\"\n";

  const std::string merge = "#!/bin/bash\n" + sbatch_line("--job-name=" + sbatch_word("rubble-merge-" + plan.name)) +
                            sbatch_line("--output=" + sbatch_word(logs + "merge.log")) + environment(plan) +
                            shell_word(plan.program) + " batch merge " + shell_word(plan.out) + " --out " +
                            shell_word(plan.out + "/results.sqlite") + "\n" + shell_word(plan.program) +
                            " batch report " + shell_word(plan.out) + "\n";
  return {array, merge};
}

SlurmScripts write_slurm(const SlurmPlan& plan) {
  std::error_code error;
  refuse_run_folder(plan.out);
  fs::create_directories(place_in(plan.out, "slurm"), error);
  if (error) throw InputError(plan.out + ": cannot be created (" + error.message() + "); give a writable --out");
  const SlurmScripts scripts = slurm_scripts(plan);
  const SlurmScripts paths{place_in(plan.out, "slurm/array.sh"), place_in(plan.out, "slurm/merge.sh")};
  write_text_file(paths.array, scripts.array);
  write_text_file(paths.merge, scripts.merge);
  return paths;
}

SlurmJobs submit_slurm(const SlurmScripts& paths) {
  SlurmJobs jobs;
  jobs.array = submit(shell_word(paths.array));
  jobs.merge = submit("--dependency=afterany:" + jobs.array + " " + shell_word(paths.merge));
  return jobs;
}

}  // namespace rubble::scenarios
