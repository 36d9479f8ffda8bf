# `cmake --install build/release --prefix DIR`: the program with what it ships, and the rooms as libraries that
# `find_package(rubble)` finds (docs/extending.md, "Use rubble as a library").
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(rubble_modules GLOBAL PROPERTY rubble_modules)
include(cmake/module_version.cmake)  # of what is installed apart

set(rubble_package ${CMAKE_INSTALL_LIBDIR}/cmake/rubble)
set(rubble_rooms base robot arenas sim slam explore scoring scenarios)

# Headers lie below include/rubble, so that they are <rubble/slam/mapper.h>; among themselves they say "slam/mapper.h".
foreach(room ${rubble_rooms})
  add_library(rubble::${room} ALIAS rubble_${room})
  set_target_properties(rubble_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(rubble_${room} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/rubble>)
  list(APPEND rubble_targets rubble_${room})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rubble
          FILES_MATCHING PATTERN "*.h"
          PATTERN "shipped" EXCLUDE PATTERN "sweeps" EXCLUDE PATTERN "pages" EXCLUDE
          PATTERN "drivers" EXCLUDE PATTERN "emulators" EXCLUDE PATTERN "hardware" EXCLUDE)
endforeach()
install(TARGETS ${rubble_targets} rubble_geotiff_system EXPORT rubble ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT rubble NAMESPACE rubble:: DESTINATION ${rubble_package})
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/rubble-config.cmake.in ${CMAKE_BINARY_DIR}/rubble-config.cmake
                              INSTALL_DESTINATION ${rubble_package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/rubble-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/rubble-config.cmake ${CMAKE_BINARY_DIR}/rubble-config-version.cmake
        DESTINATION ${rubble_package})

install(TARGETS rubble RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ${rubble_modules} LIBRARY DESTINATION lib/rubble)
# Programs of others find the modules by their run path (base/module.h).
target_link_options(rubble_base INTERFACE "$<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/lib/rubble>")
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenarios ${CMAKE_SOURCE_DIR}/arenas ${CMAKE_SOURCE_DIR}/robots DESTINATION ${CMAKE_INSTALL_DATADIR}/rubble
        FILES_MATCHING PATTERN "*.yaml" PATTERN "*.baseline.json")
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/rubble)
