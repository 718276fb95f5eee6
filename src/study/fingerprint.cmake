# Writes OUT: the SHA-256 of the text FLAGS and of all sources in the folder SOURCES, by name and content.
file(GLOB_RECURSE files RELATIVE ${SOURCES} ${SOURCES}/*.cpp ${SOURCES}/*.hpp)
set(all "${FLAGS}")
foreach(file ${files})
  file(SHA256 ${SOURCES}/${file} hash)
  string(APPEND all "|${file} ${hash}")
endforeach()
string(SHA256 hash "${all}")
file(WRITE ${OUT} "namespace elamin {\nextern const char* const fingerprint_of_sources;\nconst char* const fingerprint_of_sources = \"${hash}\";\n}\n")
