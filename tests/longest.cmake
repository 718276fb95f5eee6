# The tests that take longest, in seconds: ctest begins with them, so that no core waits for them at the end.
set_tests_properties("the events and the end of a path do not depend on its steps and its method, and satisfy their own equations" PROPERTIES COST 150)
set_tests_properties("a strip meets a stop: every contact is one" PROPERTIES COST 40)
set_tests_properties("load steps go on at contacts, branch points, limit points and behind jumps" PROPERTIES COST 35)
set_tests_properties("branches in arc length have the same bits for one, two and four threads" PROPERTIES COST 35)
set_tests_properties("every fall of two beams has its event and loses energy" PROPERTIES COST 25)
set_tests_properties("the ends of a column meet and pass each other" PROPERTIES COST 20)
set_tests_properties("a buckled arch flips through limit points and branch points, and along the path between them" PROPERTIES COST 25)
