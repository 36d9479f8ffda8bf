#include "scenarios/batch/slurm.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "base/error.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using testing::HasSubstr;

class Slurm : public FolderTest {
 protected:
  SlurmPlan plan() const {
    SlurmPlan plan;
    plan.name = "levelling";
    plan.sweep = "/home/a b/sweep.yaml";
    plan.out = path("out");
    plan.program = "/opt/rubble";
    plan.shards = 12;
    plan.workers = 3;
    return plan;
  }
};

TEST_F(Slurm, EveryTaskMakesItsShard) {
  SlurmPlan p = plan();
  p.overrides = {{"mapper.icp", "false"}};
  p.options = {"--partition=long", "--time=2:00:00"};
  const std::string array = slurm_scripts(p).array;
  EXPECT_THAT(array, HasSubstr("#SBATCH --array=1-12\n"));
  EXPECT_THAT(array, HasSubstr("#SBATCH --cpus-per-task=3\n"));
  EXPECT_THAT(array, HasSubstr("#SBATCH --partition=long\n#SBATCH --time=2:00:00\n"));
  EXPECT_THAT(array, HasSubstr("'/opt/rubble' batch '/home/a b/sweep.yaml'"));
  EXPECT_THAT(array, HasSubstr("--workers 3 --set 'mapper.icp=false' --shard \"$SLURM_ARRAY_TASK_ID/12\""));
  EXPECT_EQ(array.rfind("#!/bin/bash\n#SBATCH", 0), 0u) << "sbatch stops reading its lines at the first command";
}

TEST_F(Slurm, WordsSurviveTheShell) {
  for (const std::string word : {"plain", "two words", "it's", "$HOME `ls` \"x\" \\ ;", ""}) {
    const std::string command = "printf %s " + shell_word(word) + " > " + shell_word(path("said"));
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read(path("said")), word);
  }
}

TEST_F(Slurm, TheMergeWaitsForTheArray) {
  // A sbatch of our own notes how it was called and answers as the real one does on a federated cluster.
  write("bin/sbatch", "#!/bin/sh\necho \"$@\" >> " + path("calls") + "\necho '4711;cluster'\n");
  std::filesystem::permissions(path("bin/sbatch"), std::filesystem::perms::owner_all);
  const std::string old_path = std::getenv("PATH");
  setenv("PATH", (path("bin") + ":" + old_path).c_str(), 1);
  const SlurmJobs jobs = submit_slurm(write_slurm(plan()));
  setenv("PATH", old_path.c_str(), 1);
  EXPECT_EQ(jobs.array, "4711");
  const std::string out = path("out");
  EXPECT_EQ(read(path("calls")), "--parsable " + out + "/slurm/array.sh\n--parsable --dependency=afterany:4711 " + out +
                                     "/slurm/merge.sh\n");
  EXPECT_THAT(read(out + "/slurm/merge.sh"), HasSubstr("batch merge '" + out + "' --out '" + out + "/results.sqlite'"));
}

TEST_F(Slurm, WhatSbatchRefusesIsPassedOn) {
  write("bin/sbatch", "#!/bin/sh\necho 'sbatch: error: invalid partition' >&2\nexit 1\n");
  std::filesystem::permissions(path("bin/sbatch"), std::filesystem::perms::owner_all);
  const std::string old_path = std::getenv("PATH");
  setenv("PATH", (path("bin") + ":" + old_path).c_str(), 1);
  std::string said;
  try {
    submit_slurm(write_slurm(plan()));
  } catch (const RunError& error) {
    said = error.what();
  }
  setenv("PATH", old_path.c_str(), 1);
  EXPECT_THAT(said, HasSubstr("invalid partition"));
}

}  // namespace
}  // namespace rubble::scenarios
