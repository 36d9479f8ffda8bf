# Writes version.h when the version or the commit changed; run at every build.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
set(content "#pragma once

namespace rubble::scenarios {

constexpr const char* kVersion = \"${VERSION}\";
constexpr const char* kCommit = \"${commit}\";
constexpr const char* kBuildType = \"${BUILD_TYPE}\";

}  // namespace rubble::scenarios
")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT "${old}" STREQUAL "${content}")
  file(WRITE ${OUTPUT} "${content}")
endif()
