#define CATCH_CONFIG_RUNNER
#include "core/memory.hpp"

#include "catch.hpp"

int main(int argc, char** argv) {
  elamin::keep_freed_memory();                   // as the program does
  return Catch::Session().run(argc, argv);
}
