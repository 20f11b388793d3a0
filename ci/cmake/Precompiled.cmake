# Precompiled headers: half of a build from nothing is reading the same library headers 380 times.
# One for the program and one for the tests, each used by every target below its folders. Off beside a compiler cache
# (CMAKE_CXX_COMPILER_LAUNCHER), which precompiled headers would blind; then each file proves its own includes. Off with clang, whose
# OpenMP flag, needed everywhere once the header has it, refuses structured bindings in lambdas.
if(CMAKE_CXX_COMPILER_LAUNCHER OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(precompile OFF)
else()
  set(precompile ON)
endif()
option(SPINDRIFT_PRECOMPILED "Read the common library headers once (precompiled headers)" ${precompile})
if(NOT SPINDRIFT_PRECOMPILED)
  return()
endif()

# What a precompiled header was made with its users must be compiled with too.
target_compile_options(spindrift_flags INTERFACE ${OpenMP_CXX_FLAGS})
target_link_libraries(spindrift_flags INTERFACE fmt::fmt)

set(common_headers <algorithm> <array> <charconv> <chrono> <cmath> <cstring> <filesystem> <fstream> <functional> <limits> <map> <memory>
  <numbers> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view> <vector>
  <fmt/format.h> <Eigen/Core> <Eigen/Geometry> <Eigen/LU>)
file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "// Carries the precompiled header that other targets use.\n")

function(spindrift_precompile carrier folders)
  add_library(${carrier} STATIC ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${carrier} PRIVATE spindrift_flags Eigen3::Eigen)
  target_precompile_headers(${carrier} PRIVATE ${ARGN})
  while(folders)
    list(POP_FRONT folders folder)
    get_property(inner DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
    list(APPEND folders ${inner})
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type MATCHES "EXECUTABLE|STATIC_LIBRARY|OBJECT_LIBRARY")
        target_precompile_headers(${target} REUSE_FROM ${carrier})
      endif()
    endforeach()
  endwhile()
endfunction()
