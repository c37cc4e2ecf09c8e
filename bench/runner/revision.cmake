# Writes the header that tells the revision of the source tree, at build time, only when it has changed.
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT
  "#pragma once\nnamespace crumble::bench {\ninline constexpr const char* kRevision = \"${revision}\";\n}\n")
