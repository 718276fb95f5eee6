# find_package(elamin) gives the target elamin::elamin.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(OpenMP)
find_dependency(fmt)
include(${CMAKE_CURRENT_LIST_DIR}/elaminTargets.cmake)
