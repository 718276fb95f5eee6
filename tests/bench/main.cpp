// The benchmarks that are C++, as one program:
//
//     bench NAME …            what each takes stands at the head of its file
#include <cstdio>
#include <map>
#include <string>

namespace bodies_speed { int main(int, char**); }
namespace packings { int main(int, char**); }
namespace path_points { int main(int, char**); }
namespace path_stress { int main(int, char**); }
namespace scale { int main(int, char**); }
namespace verlet_speed { int main(int, char**); }

int main(int count, char** words) {
  const std::map<std::string, int (*)(int, char**)> all{{"bodies_speed", bodies_speed::main}, {"packings", packings::main}, {"path_points", path_points::main},
                                                        {"path_stress", path_stress::main}, {"scale", scale::main}, {"verlet_speed", verlet_speed::main}};
  if (const auto found = count > 1 ? all.find(words[1]) : all.end(); found != all.end()) return found->second(count - 1, words + 1);
  std::fputs("bench NAME …; NAME is one of", stderr);
  for (const auto& [name, run] : all) std::fprintf(stderr, " %s", name.c_str());
  std::fputs("\n", stderr);
  return 1;
}
