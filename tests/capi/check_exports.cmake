# cmake -DNM=... -DLIBRARY=... -DEXPECTED=... -P: the shared library exports the functions of the list and nothing else.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${NM} -D --defined-only --without-symbol-versions ${LIBRARY}
  OUTPUT_VARIABLE table COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^ \n]+\n" symbols "${table}")
list(TRANSFORM symbols STRIP)
list(FILTER symbols EXCLUDE REGEX "^CRUMBLE_[0-9.]+$") # the version node
list(SORT symbols)
file(STRINGS ${EXPECTED} expected)
foreach(symbol IN LISTS symbols)
  if(NOT symbol IN_LIST expected)
    message(SEND_ERROR "exported, not in the list: ${symbol}")
  endif()
endforeach()
foreach(symbol IN LISTS expected)
  if(NOT symbol IN_LIST symbols)
    message(SEND_ERROR "in the list, not exported: ${symbol}")
  endif()
endforeach()
