# Headers that many files of a room include, precompiled once. No header of our own is among them, so that who includes whom
# stays what the files say.

# Without these words ccache keeps nothing that uses a precompiled header.
function(rubble_keep_precompiled target)
  if(CCACHE)
    target_compile_options(${target} PRIVATE -fpch-preprocess)
    set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime;${CCACHE}")
  endif()
endfunction()

# rubble_headers(<name> [FAST] LIBRARIES ... HEADERS ...): precompiles the headers; FAST: for what rubble_compile_fast()
# compiles, since the compiler takes them only at the optimisation they were made with.
function(rubble_headers name)
  if(NOT RUBBLE_PCH)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 of "FAST" "" "LIBRARIES;HEADERS")
  set(source ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${name} OBJECT ${source})
  if(of_FAST)
    rubble_compile_fast(${name})
  endif()
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wconversion -Werror)
  target_link_libraries(${name} PRIVATE ${of_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${of_HEADERS})
  rubble_keep_precompiled(${name})
endfunction()

# rubble_precompiled(<target> <name>): compiles the target with them.
function(rubble_precompiled target name)
  if(RUBBLE_PCH)
    target_precompile_headers(${target} REUSE_FROM ${name})
    rubble_keep_precompiled(${target})
  endif()
endfunction()

set(language <algorithm> <array> <cmath> <cstdint> <cstdio> <fstream> <functional> <limits> <map> <memory> <optional>
             <set> <sstream> <string> <utility> <vector>)
set(poses <mrpt/math/TPose2D.h> <mrpt/math/TPose3D.h>)
rubble_headers(rubble_room_headers LIBRARIES mrpt::math HEADERS ${poses} ${language})
rubble_headers(rubble_matrix_headers LIBRARIES mrpt::math Eigen3::Eigen HEADERS <Eigen/Dense> ${poses} ${language})
rubble_headers(rubble_image_headers
               LIBRARIES mrpt::math opencv_core opencv_imgproc HEADERS <opencv2/imgproc.hpp> ${poses} ${language})
rubble_headers(rubble_fast_headers FAST LIBRARIES mrpt::math HEADERS ${poses} <filesystem> ${language})
