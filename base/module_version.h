#pragma once

/// What the headers said, of which modules and program know each other's classes, when this file was compiled: two that
/// differ in it must not meet. cmake/module_version.cmake makes it.
extern "C" const char rubble_module_version[];
