# Language standard, output folders, warnings and the processor option, for every target of this project.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)

add_library(mso_settings INTERFACE)
target_compile_options(mso_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # GCC takes anonymous namespaces of files that are compiled together for parts of headers.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
  # Results must not depend on whether the compiler fuses a multiplication and an addition.
  -ffp-contract=off
  $<$<BOOL:${MSO_WARNINGS_AS_ERRORS}>:-Werror>
  $<$<BOOL:${MSO_NATIVE}>:-march=native>)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
