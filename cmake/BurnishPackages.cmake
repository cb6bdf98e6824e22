# SPDX-License-Identifier: Apache-2.0
# Installs the further files of packages, besides programs, headers and libraries, and makes the Debian packages (`make
# deb`).

# These lines set the package's own version and its changelog.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
configure_file(cmake/debian-changelog.in debian-changelog @ONLY)

# Installs the documents that every Debian package must have, in its own folder, compressed by Debian's policy.
function(burnish_debian_documents package component)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${package}\")
    file(MAKE_DIRECTORY \"\${folder}\")
    configure_file(\"${PROJECT_SOURCE_DIR}/cmake/debian-copyright\" \"\${folder}/copyright\" COPYONLY)
    configure_file(\"${PROJECT_SOURCE_DIR}/CHANGELOG.md\" \"\${folder}/changelog\" COPYONLY)
    configure_file(\"${PROJECT_BINARY_DIR}/debian-changelog\" \"\${folder}/changelog.Debian\" COPYONLY)
    execute_process(COMMAND gzip -9nf \"\${folder}/changelog\" \"\${folder}/changelog.Debian\"
      COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
endfunction()
# These lists name the packages and, for each, the component of files that are there once a package.
set(burnish_debian_packages burnish libburnish-dev)
set(burnish_debian_components programs burnish)
foreach(package component IN ZIP_LISTS burnish_debian_packages burnish_debian_components)
  burnish_debian_documents(${package} ${component})
  # Debian has no bug report that asks for the first version.
  file(WRITE ${PROJECT_BINARY_DIR}/lintian/${package} "${package}: initial-upload-closes-no-bugs\n")
  install(FILES ${PROJECT_BINARY_DIR}/lintian/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    COMPONENT ${component})
endforeach()

# Installs the command line's descriptions of itself in the forms that a system looks for, compressed by Debian's
# policy.
set(describe "\"$<TARGET_FILE:burnish_cli>\" describe")
install(CODE "
  set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  file(MAKE_DIRECTORY \"\${share}/bash-completion/completions\" \"\${share}/zsh/vendor-completions\")
  execute_process(COMMAND ${describe} -o \"\${share}/man/man1\" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${describe} --bash COMMAND_ERROR_IS_FATAL ANY
    OUTPUT_FILE \"\${share}/bash-completion/completions/burnish\")
  execute_process(COMMAND ${describe} --zsh COMMAND_ERROR_IS_FATAL ANY
    OUTPUT_FILE \"\${share}/zsh/vendor-completions/_burnish\")
  file(GLOB pages \"\${share}/man/man1/burnish*.1\")
  execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT programs)

# Installs the file for pkg-config, in an architecture's folder where the system keeps several. The prefix is found
# relative to the file's place.
find_package(embree REQUIRED)  # gives its version
cmake_path(SET burnish_pc_folder NORMALIZE lib/${CMAKE_LIBRARY_ARCHITECTURE}/pkgconfig)
string(REGEX REPLACE "[^/]+" ".." burnish_pc_to_prefix ${burnish_pc_folder})
set(burnish_pc_lapack "-llapack -lblas ")
if(BURNISH_EIGEN_LAPACK)
  set(burnish_pc_lapack)
endif()
configure_file(cmake/burnish.pc.in burnish.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/burnish.pc DESTINATION ${burnish_pc_folder} COMPONENT burnish)

# There are two packages. burnish has programs, manual pages and completions. libburnish-dev has headers, the static
# libraries and the files that find them. `make build` builds both.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "burnish developers <burnish@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "measured reflectance as a few small positive textures")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION
"Turns any BRDF, measured, scattered or analytic, into a few small positive
textures and a short shader, with a known error. Reads MERL, RGL, Cornell,
MBSDF, Zemax, Klems, ASTM E1392, OpenMATERIAL, ALTA, Speos, simple scattering,
LightTools, Integra, SSDD, FRED, UTIA, tensor trees, Fourier BSDFs and CSV
files as they are. Also evaluates glossy highlights without pow, from SIMD code
to a hardware block.
.
This package holds the command line and its manual pages.")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"Headers and static libraries of burnish. burnish::eval evaluates models with
the C++ standard library alone; burnish::fit, burnish::io, burnish::render and
burnish::library stand on it, and on what this package suggests.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL programs eval fit io render library burnish)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME burnish)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libburnish-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# A program that links more than burnish::eval needs these packages.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libtbb-dev, libopenexr-dev, libpng-dev, libpugixml-dev, \
libopenblas-serial-dev, libepoxy-dev, libembree-dev, libzstd-dev, libsqlite3-dev")
include(CPack)
cpack_add_component_group(programs)
cpack_add_component_group(development)
cpack_add_component(programs GROUP programs)
foreach(component IN ITEMS eval fit io render library burnish)
  cpack_add_component(${component} GROUP development)
endforeach()
