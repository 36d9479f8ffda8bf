#include "base/module_version.h"

#include "base/module_headers.h"

// Program and modules have one each; a module's is found by its name.
extern "C" __attribute__((visibility("default"))) const char rubble_module_version[] = RUBBLE_MODULE_HEADERS;
