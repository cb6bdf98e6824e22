# Flags every target of the project shares; call once on each target.
function(burnish_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    -Wno-missing-field-initializers  # designated initializers leave the rest at its defaults
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # false alarms of g++ 12 in <string>
  # memory for time, a sixth of which the compiler else takes to free some
  target_compile_options(${name} PRIVATE
    "$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=300;--param=ggc-min-heapsize=500000>")
  if(BURNISH_WERROR)
    target_compile_options(${name} PRIVATE -Werror)
  endif()
  if(BURNISH_SANITIZE)
    # g++ takes a third of its time for checks of each pointer: the address sanitizer sees null and ends of objects as
    # well, and bytes become numbers by copies here. The fuzz preset, by clang, has all.
    target_compile_options(${name} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null,alignment,object-size,vptr,pointer-overflow>)
    target_link_options(${name} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# Runs a program of GoogleTest tests in parts, side by side: starting it once a test takes longer than most tests,
# with sanitizers above all. Only what fails or is skipped is printed.
# GCC 12's leak check takes the thread-local memory of one library in 256, where the address happens to end in 0x010,
# for that of a glibc of 2014 and reads at the size of a block of memory: it is told to leave such memory alone.
# The tests that tests/sanitized/left_out.txt names run in parts of their own, with the label `long`, begun first; with
# sanitizers they do not.
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

# The tests of a program that a filter lets through, in parts NAME.0 and so on; further arguments: their properties.
function(burnish_test_parts program name parts filter)
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${name}.${part} COMMAND ${program})
    set_tests_properties(${name}.${part} PROPERTIES ${ARGN} ENVIRONMENT "GTEST_FILTER=${filter};\
GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part};GTEST_BRIEF=1;ASAN_OPTIONS=intercept_tls_get_addr=0")
  endforeach()
endfunction()

# Makes text files a part of a target: FUNCTION(), which the target declares, returns those that match the patterns, by
# name, as std::span<const burnish::EmbeddedFile>.
function(burnish_embed target function)
  file(GLOB files CONFIGURE_DEPENDS ${ARGN})
  list(SORT files)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${script} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} "-DFILES=${files}" -DOUTPUT=${output} -P ${script})
  target_sources(${target} PRIVATE ${output})
endfunction()

# The files of a folder are read by the compiler together, at most so many at a time: most of its work on each would
# be the same headers. Arguments: a target of this directory, how many, then the files that stay alone. Files with
# options of their own do anyway.
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

# burnish_unity for files of several rings: those of a folder are read together whatever their ring, as far as it is the
# same, and under names that do not depend on it: what changes its ring is compiled anew only with its neighbours.
# Arguments: a name, how many at most, sources, the rings, then the files that stay alone. A source's ring is the list
# RING_sources that has it. Files with options or definitions of their own do
# anyway. What is to be compiled of a ring is NAME_RING_batches.
function(burnish_batches name most sources rings)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/Unity)  # as UNITY_BUILD of a target has it
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
