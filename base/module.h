#pragma once

#include <string>

namespace rubble {

/// The function `symbol` of a shared module that is loaded the first time it is asked for, and never closed: MRPT's
/// libraries leave threads and exit handlers behind. `file` is looked for beside the program, in the folder above, in
/// ../lib/rubble, and where the program's run path leads. One that was made from other headers than this program is not
/// used (base/module_version.h). Throws RunError "`what`: `file` cannot be loaded (why); `remedy`", with the path of a
/// file that is there.
void* module_function(const std::string& what, const std::string& file, const char* symbol, const std::string& remedy);

}  // namespace rubble
