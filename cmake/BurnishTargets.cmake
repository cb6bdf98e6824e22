# SPDX-License-Identifier: Apache-2.0
# Sets the flags that all targets of the project share. Call it once for each target.
function(burnish_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    -Wno-missing-field-initializers  # designated initializers leave other members at their defaults
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # false alarms of g++ 12 in <string>
  # More memory saves time: otherwise the compiler spends a sixth of it on freeing memory.
  target_compile_options(${name} PRIVATE
    "$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=300;--param=ggc-min-heapsize=500000>")
  if(BURNISH_WERROR)
    target_compile_options(${name} PRIVATE -Werror)
  endif()
  if(BURNISH_SANITIZE)
    # g++ spends a third of its time on checks of each pointer. The address sanitizer sees null pointers and ends of
    # objects as well, and this code turns bytes into numbers by copies. The fuzz preset, with clang, has all checks.
    target_compile_options(${name} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null,alignment,object-size,vptr,pointer-overflow>)
    target_link_options(${name} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# Runs a program of GoogleTest tests in parts, side by side. Starting it for each test takes longer than most tests,
# above all with sanitizers. Only failed and skipped tests are printed.
# GCC 12's leak check mistakes thread-local memory for that of a glibc of 2014 where the address ends in 0x010, for one
# library in 256. It then reads at the size of a block of memory. An option makes it ignore this memory.
# Tests in tests/sanitized/left_out.txt run in parts of their own, with the label `long`, and start first. With
# sanitizers they do not run.
function(burnish_tests name parts)
  set(list ${PROJECT_SOURCE_DIR}/tests/sanitized/left_out.txt)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  file(STRINGS ${list} long REGEX "^[^# ]")
  list(JOIN long ":" long)
  burnish_test_parts(${name} "${name}" ${parts} "-${long}")
  if(NOT BURNISH_SANITIZE)
    burnish_test_parts(${name} "${name}.long" ${parts} "${long}" LABELS long COST 10)
  endif()
endfunction()

# Adds the tests that a filter selects, in parts NAME.0 and so on. Further arguments are the tests' properties.
function(burnish_test_parts program name parts filter)
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${name}.${part} COMMAND ${program})
    set_tests_properties(${name}.${part} PROPERTIES ${ARGN} ENVIRONMENT "GTEST_FILTER=${filter};\
GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part};GTEST_BRIEF=1;ASAN_OPTIONS=intercept_tls_get_addr=0")
  endforeach()
endfunction()

# Embeds text files in a target. FUNCTION(), which the target declares, returns the files that match the patterns,
# sorted by name, as std::span<const burnish::EmbeddedFile>.
function(burnish_embed target function)
  file(GLOB files CONFIGURE_DEPENDS ${ARGN})
  list(SORT files)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${script} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} "-DFILES=${files}" -DOUTPUT=${output} -P ${script})
  target_sources(${target} PRIVATE ${output})
endfunction()

# Compiles the files of a folder together, at most so many at a time, since most of the work on each would be the same
# headers. Arguments are a target of this directory, the number, then the files that stay alone. Files with options of
# their own stay alone too.
function(burnish_unity target most)
  if(NOT BURNISH_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/.*\\.cpp$")
  list(TRANSFORM sources REPLACE "^${CMAKE_CURRENT_SOURCE_DIR}/" "")
  list(REMOVE_ITEM sources ${ARGN})
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      continue()
    endif()
    if(NOT DEFINED "count_${folder}" OR "${count_${folder}}" EQUAL most)
      set("count_${folder}" 0)
      string(MAKE_C_IDENTIFIER "${source}" "group_${folder}")
    endif()
    math(EXPR "count_${folder}" "${count_${folder}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${group_${folder}}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# Does the same as burnish_unity for files of several rings. Files of a folder are compiled together as long as their
# ring is the same. The names of batches do not depend on the ring, so a file that changes its ring is compiled again
# with its neighbours alone.
# Arguments are a name, the largest number, sources, the rings, then the files that stay alone. A source's ring is the
# list RING_sources that holds it. Files with options or definitions of their own stay alone too. The function sets
# NAME_RING_batches to the sources to compile for a ring.
function(burnish_batches name most sources rings)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/Unity)  # as for a UNITY_BUILD target
  set(alone ${ARGN})
  foreach(source IN LISTS sources)
    foreach(ring IN LISTS rings)
      if(source IN_LIST ${ring}_sources)
        set(ring_of ${ring})
        break()
      endif()
      set(ring_of)
    endforeach()
    string(REPLACE "${CMAKE_CURRENT_SOURCE_DIR}/" "" relative ${source})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(NOT BURNISH_UNITY OR options OR relative IN_LIST alone)
      if(ring_of)
        list(APPEND ${ring_of}_batches ${source})
      endif()
      continue()
    endif()
    get_filename_component(directory ${relative} DIRECTORY)
    if(NOT DEFINED "count_${directory}" OR "${count_${directory}}" EQUAL most)
      set("count_${directory}" 0)
      string(MAKE_C_IDENTIFIER "${relative}" batch)
      set("batch_${directory}" ${batch})
    endif()
    math(EXPR "count_${directory}" "${count_${directory}} + 1")
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    if(ring_of AND definitions)
      list(APPEND ${ring_of}_batches ${source})
    endif()
    if(definitions OR NOT ring_of)
      continue()
    endif()
    set(batch "${batch_${directory}}")
    if(NOT DEFINED "ring_${batch}")
      set("ring_${batch}" ${ring_of})
    endif()
    if(NOT ring_of STREQUAL "${ring_${batch}}")
      string(APPEND batch "_${ring_of}")
    endif()
    if(NOT DEFINED "text_${batch}")
      set("text_${batch}" "/* generated by CMake */\n\n")
      list(APPEND ${ring_of}_files ${batch})
    endif()
    string(APPEND "text_${batch}" "#include \"${source}\"\n\n")
  endforeach()
  foreach(ring IN LISTS rings)
    foreach(batch IN LISTS ${ring}_files)
      file(CONFIGURE OUTPUT ${folder}/unity_${batch}_cxx.cxx CONTENT "${text_${batch}}" @ONLY)
      list(APPEND ${ring}_batches ${folder}/unity_${batch}_cxx.cxx)
    endforeach()
    set(${name}_${ring}_batches ${${ring}_batches} PARENT_SCOPE)
  endforeach()
endfunction()
