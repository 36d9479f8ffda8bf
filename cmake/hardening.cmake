# Debian's hardening flags. What a wrong index or a foreign file could do ends the program instead; the bits of the results
# are the same, cost in docs/reliability.md. Not under sanitizers, whose own checks _FORTIFY_SOURCE hides.
option(RUBBLE_HARDEN "Compile with Debian's hardening flags" ON)
if(NOT RUBBLE_HARDEN)
  return()
endif()
add_compile_options(-fstack-protector-strong -Wformat -Werror=format-security)
if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")  # the C library wants an optimising compiler for it
  add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
endif()
set(module "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>")
set(program "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>")
add_compile_options($<$<NOT:${module}>:-fPIE>)
add_link_options($<${program}:-pie> LINKER:-z,relro,-z,now)
