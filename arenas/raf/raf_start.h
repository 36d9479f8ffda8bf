#pragma once

#include <string>
#include <vector>

#include "arenas/raf/raf.h"
#include "arenas/raf/raf_layout.h"

namespace rubble::arenas {

/// Sets the start of `import.arena` and says where in `import.start_note`: at a start check, else on the largest flat
/// stretch that can be driven on. Throws InputError when there is no room for the robot.
void find_start(const Layout& layout, const std::vector<Element>& elements, const std::string& name, RafImport& import);

}  // namespace rubble::arenas
