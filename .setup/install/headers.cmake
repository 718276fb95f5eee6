# At installation: copies the headers of ${source} to ${staged}/elamin, where each names the others from there (<elamin/core/types.hpp>), so
# that none is confused with a header of the program that includes it, and asks behind Eigen/Core for the alignment of the library.
file(REMOVE_RECURSE ${staged}/elamin)
file(GLOB_RECURSE headers RELATIVE ${source} ${source}/*.hpp)
list(FILTER headers EXCLUDE REGEX "^(python|petsc)/")
foreach(header ${headers})
  file(READ ${source}/${header} text)
  string(REGEX REPLACE "#include \"([^\"]+)\"" "#include <elamin/\\1>" text "${text}")
  string(REPLACE "#include <Eigen/Core>\n" "#include <Eigen/Core>\n#include <elamin/alignment.hpp>\n" text "${text}")
  file(WRITE ${staged}/elamin/${header} "${text}")
endforeach()
file(WRITE ${staged}/alignment.cpp "#include <Eigen/Core>\nEIGEN_MAX_ALIGN_BYTES==EIGEN_MAX_STATIC_ALIGN_BYTES\n")
execute_process(COMMAND ${compiler} -E -P ${staged}/alignment.cpp OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "([0-9]+)==([0-9]+)[ \n]*$" found "${text}")
file(WRITE ${staged}/elamin/alignment.hpp "#pragma once
#include <Eigen/Core>

static_assert(EIGEN_MAX_ALIGN_BYTES == ${CMAKE_MATCH_1} && EIGEN_MAX_STATIC_ALIGN_BYTES == ${CMAKE_MATCH_2},
              \"elamin was built with another alignment of Eigen's: compile with the flags of `pkg-config --cflags elamin`, \"
              \"or link to the CMake target elamin::elamin\");
")
