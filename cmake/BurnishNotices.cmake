# SPDX-License-Identifier: Apache-2.0
# Installs THIRD_PARTY_NOTICES and the SBOM of a package, written by notices/notices.py. Without Python they are left
# out.
find_package(Python3 QUIET COMPONENTS Interpreter)

# burnish_notices_command(RESULT PACKAGE NOTICES SBOM [--python FOLDER]) sets RESULT to the command, as a list.
function(burnish_notices_command result package notices sbom)
  set(${result} ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/notices/notices.py ${package}
    --version ${PROJECT_VERSION} --notices ${notices} --sbom ${sbom} ${ARGN} PARENT_SCOPE)
endfunction()

# burnish_install_notices(PACKAGE COMPONENT NOTICES SBOM [--python FOLDER]) takes paths below the prefix, or absolute
# ones.
function(burnish_install_notices package component notices sbom)
  if(NOT Python3_Interpreter_FOUND)
    return()
  endif()
  foreach(path IN ITEMS notices sbom)
    if(NOT IS_ABSOLUTE ${${path}})
      set(${path} "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${${path}}")
    endif()
  endforeach()
  burnish_notices_command(command ${package} ${notices} ${sbom} ${ARGN})
  list(JOIN command "\" \"" command)
  install(CODE "execute_process(COMMAND \"${command}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
endfunction()
