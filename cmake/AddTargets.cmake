# PRECOMPILE below names headers of other projects that most sources of the target include: parsing them once
# halves the time that a clean build takes. The preset "dev" goes without, so that each file says what it needs.

# mso_add_library(NAME [PLUGIN] SOURCES ... [DEPENDS ...] [PRIVATE_DEPENDS ...] [PRECOMPILE ...])
# A library of libs/NAME with its public headers in libs/NAME/include/NAME, known as mrpt_semantic_octree::NAME.
# A PLUGIN is loaded by its name without a version, which is part of the library's package then.
function(mso_add_library name)
  cmake_parse_arguments(ARG "PLUGIN" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS;PRECOMPILE" ${ARGN})
  set(link_component development)
  if(ARG_PLUGIN)
    set(link_component library)
  endif()
  add_library(${name} SHARED ${ARG_SOURCES})
  target_precompile_headers(${name} PRIVATE ${ARG_PRECOMPILE})
  add_library(mrpt_semantic_octree::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/mrpt_semantic_octree>)
  target_compile_features(${name} PUBLIC cxx_std_17)
  target_link_libraries(${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:mso_settings> ${ARG_PRIVATE_DEPENDS})
  set_target_properties(${name} PROPERTIES OUTPUT_NAME mso_${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
  set_property(GLOBAL APPEND PROPERTY MSO_LIBRARIES ${name})
  set_property(GLOBAL PROPERTY MSO_LINKS_${name} ${ARG_DEPENDS})
  set_property(GLOBAL PROPERTY MSO_PRIVATE_LINKS_${name} ${ARG_PRIVATE_DEPENDS})
  install(TARGETS ${name} EXPORT mrpt_semantic_octree_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    COMPONENT library NAMELINK_COMPONENT ${link_component})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mrpt_semantic_octree
    COMPONENT development)
endfunction()

# Programs read their command line and let the libraries work: their own code is optimized little.
set(mso_once_options $<$<CONFIG:Release>:-O1>)

# mso_add_app(NAME [STUDY] SOURCES ... [DEPENDS ...]): an executable of apps/NAME. A STUDY (test/benchmark/NAME), which
# measures this project rather than using it, is not installed; others are, with their manual page.
function(mso_add_app name)
  cmake_parse_arguments(ARG "STUDY" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  if(NOT ARG_STUDY)
    target_compile_options(${name} PRIVATE ${mso_once_options})
  endif()
  target_link_libraries(${name} PRIVATE mso_settings application ${ARG_DEPENDS})
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  set_property(GLOBAL APPEND PROPERTY MSO_APPS ${name})
  if(ARG_STUDY)
    return()
  endif()
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/completion.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${name} COMPONENT tools)
  mso_add_manual(${name})
endfunction()

# mso_add_manual(NAME): the program's page of the manual, from what it says of itself.
function(mso_add_manual name)
  set(script ${PROJECT_SOURCE_DIR}/cmake/Manual.cmake)
  set(page ${CMAKE_BINARY_DIR}/man/${name}.1)
  add_custom_command(OUTPUT ${page}.gz DEPENDS ${name} ${script} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DVERSION=${PROJECT_VERSION} -DPAGE=${page} -P ${script}
    COMMAND gzip -9nf ${page})  # as Debian wants it
  add_custom_target(${name}-manual ALL DEPENDS ${page}.gz)
  install(FILES ${page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
endfunction()

# What all tests are built with. Their own code is compiled once and runs for moments: it is optimized little.
add_library(mso_test_settings INTERFACE)
target_compile_options(mso_test_settings INTERFACE $<$<CONFIG:Release>:-O1>)
target_link_libraries(mso_test_settings INTERFACE GTest::gtest GTest::gtest_main rapidcheck
  nlohmann_json::nlohmann_json)

# mso_add_test(NAME [MRPT] [WHOLE] SOURCES ... [DEPENDS ...]): one GoogleTest program, each of its cases one ctest.
# With WHOLE all cases are one ctest: what they share takes longer to make than what each of them does.
# With MRPT it takes the precompiled headers that have MRPT's observations, too (test/support/CMakeLists.txt).
# Tests find the sources through MSO_SOURCE_DIR, the programs through MSO_BIN_DIR, and data that is not in
# the repository through the environment variable SEMANTIC_OCTREE_DATA.
function(mso_add_test name)
  cmake_parse_arguments(ARG "MRPT;WHOLE" "TIMEOUT" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set(precompiled test_precompiled)
  if(ARG_MRPT)
    set(precompiled test_precompiled_mrpt)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_precompile_headers(${name} REUSE_FROM ${precompiled})
  target_link_libraries(${name} PRIVATE mso_settings mso_test_settings ${ARG_DEPENDS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/test/support)
  target_compile_definitions(${name} PRIVATE
    MSO_SOURCE_DIR="${PROJECT_SOURCE_DIR}" MSO_BIN_DIR="${CMAKE_BINARY_DIR}/bin" MSO_LIB_DIR="${CMAKE_BINARY_DIR}/lib")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test)
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 1200)
    return()
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()
