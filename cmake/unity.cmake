# With CMAKE_UNITY_BUILD the files of one folder are compiled as one: most of what a file costs is what it includes. Hence
# names in anonymous namespaces stand once in a folder. Without it (preset dev) each file is compiled alone, so that one
# that forgets an include is found.

set(unity_most 64000)  # bytes of files compiled as one: no unit keeps a second core waiting for long

# rubble_unity(<target>): the target's files, by folder.
function(rubble_unity target)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(folder ${path} DIRECTORY)
    file(SIZE ${path} bytes)
    file(RELATIVE_PATH name ${CMAKE_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER "${name}" name)
    if(NOT DEFINED part_${name})  # files of folders below stand between those of a folder
      set(part_${name} 1)
      set(sum_${name} 0)
    endif()
    math(EXPR sum "${sum_${name}} + ${bytes}")
    if(sum GREATER unity_most AND NOT sum EQUAL bytes)
      math(EXPR part_${name} "${part_${name}} + 1")
      set(sum ${bytes})
    endif()
    set(sum_${name} ${sum})
    set(group ${name}_${part_${name}})
    set_source_files_properties(${path} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  # Types of anonymous namespaces as members: the compiler takes a file that is included for a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
