# The tests that take longest, in seconds: ctest begins with them, so that no core waits for them at the end.
set_tests_properties("the events and the end of a path do not depend on its steps and its method, and satisfy their own equations" PROPERTIES COST 150)
set_tests_properties("a strip meets a stop: every contact is one" PROPERTIES COST 40)
set_tests_properties("load steps go on at contacts, branch points, limit points and behind jumps" PROPERTIES COST 35)
set_tests_properties("branches in arc length have the same bits for one, two and four threads" PROPERTIES COST 35)
set_tests_properties("every fall of two beams has its event and loses energy" PROPERTIES COST 25)
set_tests_properties("the ends of a column meet and pass each other" PROPERTIES COST 20)
set_tests_properties("a buckled arch flips through limit points and branch points, and along the path between them" PROPERTIES COST 25)
# What shares its work between processes, which wait for each other at full speed, or between threads, takes many times as long beside another test.
foreach(shared "two ranks and one process: a sheet in contact" "two ranks and one process: lowest modes, by SLEPc"
               "two ranks and one process: a chain, its first branch point, and the branch that leaves it"
               "approximate factors and iterations find the same equilibrium of a sheet" "a sweep by three ranks, one of them killed, is finished by the next call"
               "branches in arc length have the same bits for one, two and four threads" "load steps into contact have the same bits for one, two and four threads")
  set_tests_properties("${shared}" PROPERTIES PROCESSORS 2)
endforeach()
