# A hash of the headers that program and modules share goes into both (base/module_version.h): a module beside a program
# of another version would be called by the wrong table of functions. Run as a script with -P it writes the hash, when it
# changed; included it says from which headers and for whom.
set(patterns base/*.h robot/*.h scoring/maps/image_codecs.h slam/mrpt/*.h)
if(CMAKE_SCRIPT_MODE_FILE)
  list(TRANSFORM patterns PREPEND ${SOURCE_DIR}/)
  file(GLOB_RECURSE headers ${patterns})
  list(SORT headers)
  set(all "")
  foreach(header ${headers})
    file(SHA256 ${header} hash)
    string(APPEND all ${hash})
  endforeach()
  string(SHA256 hash "${all}")
  string(SUBSTRING ${hash} 0 16 hash)
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define RUBBLE_MODULE_HEADERS \"${hash}\"\n" @ONLY)  # the same: not written
  file(TOUCH ${OUTPUT}.made)
  return()
endif()

set(version_header ${CMAKE_BINARY_DIR}/generated/base/module_headers.h)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${patterns})
add_custom_command(OUTPUT ${version_header}.made BYPRODUCTS ${version_header}
                   COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${version_header}
                           -P ${CMAKE_CURRENT_LIST_FILE}
                   DEPENDS ${headers} ${CMAKE_CURRENT_LIST_FILE})
add_custom_target(rubble_module_version DEPENDS ${version_header}.made)
set_source_files_properties(base/module_version.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON
                            INCLUDE_DIRECTORIES ${CMAKE_BINARY_DIR}/generated)
add_dependencies(rubble_base rubble_module_version)
foreach(module ${rubble_modules})
  target_sources(${module} PRIVATE ${CMAKE_SOURCE_DIR}/base/module_version.cpp)
  add_dependencies(${module} rubble_module_version)
endforeach()
