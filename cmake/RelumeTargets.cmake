# Targets of Relume. `relume_library(part DEPENDS ... )` makes the library `relume::part` out of libs/<part>:
#   include/relume/<part>/   the public headers, the only ones other parts can reach
#   src/*.cpp                the implementation and its private headers
#   tests/*_test.cpp         one GoogleTest program, tests discovered one by one
#   bench/*_bench.cpp        one Google Benchmark program
# A part sees the headers of what it DEPENDS on and of nothing else, so an arrow that points up does not compile.

add_library(relume_options INTERFACE)
set_target_properties(relume_options PROPERTIES EXPORT_NAME options)
install(TARGETS relume_options EXPORT relumeTargets)
target_compile_features(relume_options INTERFACE cxx_std_20)
target_compile_options(relume_options INTERFACE
  $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wnon-virtual-dtor;-Woverloaded-virtual>
  $<BUILD_INTERFACE:-Wno-missing-field-initializers>  # designated initializers leave the rest at their defaults on purpose
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-maybe-uninitialized;-Wno-restrict>  # GCC 12 false alarms under -O3
  $<BUILD_INTERFACE:-ffp-contract=off>  # bakes repeat bit for bit
)
if(RELUME_WERROR)
  target_compile_options(relume_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(RELUME_ISA AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  target_compile_options(relume_options INTERFACE $<BUILD_INTERFACE:-march=${RELUME_ISA}>)
endif()
if(RELUME_SANITIZE)
  add_compile_options(-fsanitize=${RELUME_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${RELUME_SANITIZE})
endif()

# Public: what the headers of this part need. Private: what only its sources need.
function(relume_library part)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PUBLIC;PRIVATE;TEST_LINKS" ${ARGN})
  set(target relume_${part})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS src/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS include/*.h)
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_include_directories(${target} PRIVATE src)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(relume::${part} ALIAS ${target})
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS include FILES ${headers})
  target_link_libraries(${target} ${scope} relume_options ${ARG_PUBLIC})
  foreach(dep IN LISTS ARG_DEPENDS)
    target_link_libraries(${target} ${scope} relume::${dep})
  endforeach()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${part} POSITION_INDEPENDENT_CODE ON)
  install(TARGETS ${target} EXPORT relumeTargets FILE_SET HEADERS)

  file(GLOB tests CONFIGURE_DEPENDS tests/*_test.cpp)
  if(RELUME_BUILD_TESTS AND tests)
    add_executable(${target}_tests ${tests})
    target_include_directories(${target}_tests PRIVATE src tests)
    target_compile_definitions(${target}_tests PRIVATE RELUME_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target}_tests PRIVATE ${target} ${ARG_PRIVATE} ${ARG_TEST_LINKS} GTest::gtest_main GTest::gmock)
    gtest_discover_tests(${target}_tests TEST_PREFIX "${part}." DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
  endif()
  file(GLOB benches CONFIGURE_DEPENDS bench/*_bench.cpp)
  if(RELUME_BUILD_BENCH AND benches)
    add_executable(${target}_bench ${benches})
    target_include_directories(${target}_bench PRIVATE src)
    target_link_libraries(${target}_bench PRIVATE ${target} ${ARG_PRIVATE} ${ARG_TEST_LINKS} benchmark::benchmark_main)
  endif()
endfunction()
