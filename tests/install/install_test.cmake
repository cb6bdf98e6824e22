# Installs BUILD under SCRATCH, compiles each installed header alone, then configures, builds and runs the consumer beside
# this file, which holds the example of SOURCE/README.md.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output
    WORKING_DIRECTORY ${SCRATCH})
  if(result)
    message(FATAL_ERROR "${ARGV}: ${result}\n${output}")
  endif()
  set(output ${output} PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)

file(GLOB_RECURSE headers RELATIVE ${SCRATCH}/prefix/include ${SCRATCH}/prefix/include/*.h)
if(NOT EXISTS ${SCRATCH}/prefix/include/burnish/burnish.h)
  message(FATAL_ERROR "burnish/burnish.h was not installed")
endif()
foreach(header IN LISTS headers)
  run(${COMPILER} -std=c++20 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I ${SCRATCH}/prefix/include
    -include ${header} -x c++ /dev/null)
endforeach()

file(READ ${SOURCE}/README.md readme)
if(NOT readme MATCHES "```cpp\n([^`]*)```")
  message(FATAL_ERROR "README.md has no example in C++")
endif()
file(WRITE ${SCRATCH}/readme_example.inc "${CMAKE_MATCH_1}")
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/consumer -G ${GENERATOR}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix -DEXAMPLE_FOLDER=${SCRATCH})
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)
# the example's measurement: few scattered samples, which are fitted in a moment
run(${SCRATCH}/prefix/bin/burnish measure ggx:alpha_x=0.3,alpha_y=0.3 -o paint.csv --count 2000)
run(${CMAKE_COMMAND} -E rename paint.csv paint.binary)
run(${SCRATCH}/consumer/consumer)
if(NOT output MATCHES "^burnish evaluates a model whose file has [1-9][0-9]* bytes\n$")
  message(FATAL_ERROR "the consumer printed '${output}'")
endif()
run(${SCRATCH}/prefix/bin/burnish --help)
