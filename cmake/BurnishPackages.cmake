# What packages hold besides programs, headers and libraries, and the Debian package itself (`make deb`).

# The package's own version, and its changelog.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
configure_file(cmake/debian-changelog.in debian-changelog @ONLY)

# What the command line says of itself, in the forms that a system looks for; compressed as Debian's policy asks.
set(describe "\"$<TARGET_FILE:burnish_cli>\" describe")
install(CODE "
  set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  file(MAKE_DIRECTORY \"\${share}/bash-completion/completions\" \"\${share}/zsh/vendor-completions\"
    \"\${share}/doc/burnish\")
  execute_process(COMMAND ${describe} -o \"\${share}/man/man1\" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${describe} --bash COMMAND_ERROR_IS_FATAL ANY
    OUTPUT_FILE \"\${share}/bash-completion/completions/burnish\")
  execute_process(COMMAND ${describe} --zsh COMMAND_ERROR_IS_FATAL ANY
    OUTPUT_FILE \"\${share}/zsh/vendor-completions/_burnish\")
  configure_file(\"${PROJECT_SOURCE_DIR}/cmake/debian-copyright\" \"\${share}/doc/burnish/copyright\" COPYONLY)
  configure_file(\"${PROJECT_SOURCE_DIR}/CHANGELOG.md\" \"\${share}/doc/burnish/changelog\" COPYONLY)
  configure_file(\"${PROJECT_BINARY_DIR}/debian-changelog\" \"\${share}/doc/burnish/changelog.Debian\" COPYONLY)
  file(GLOB pages \"\${share}/man/man1/burnish*.1\")
  execute_process(COMMAND gzip -9nf \${pages} \"\${share}/doc/burnish/changelog\"
    \"\${share}/doc/burnish/changelog.Debian\" COMMAND_ERROR_IS_FATAL ANY)")

find_package(embree REQUIRED)  # for its version
configure_file(cmake/burnish.pc.in burnish.pc @ONLY)
# of an architecture where the system keeps several
install(FILES ${PROJECT_BINARY_DIR}/burnish.pc DESTINATION lib/${CMAKE_LIBRARY_ARCHITECTURE}/pkgconfig)

# One package: programs, manual pages, completions, headers, the static library, what finds it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "burnish developers <burnish@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "measured reflectance as a few small positive textures")
set(CPACK_PACKAGE_DESCRIPTION
"Turns any BRDF, measured, scattered or analytic, into a few small positive
textures and a short shader, with a known error. Reads MERL, RGL, Cornell,
MBSDF, Zemax, Klems, ASTM E1392, OpenMATERIAL, ALTA, Speos, FRED, UTIA, tensor trees,
Fourier BSDFs and CSV files as they are. Also evaluates glossy highlights without pow, from
SIMD code to a hardware block.
.
This package holds the command line, its manual pages, and the C++ library.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What a program needs to link the static library.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libtbb-dev, libhwy-dev, libopenexr-dev, libpng-dev, libpugixml-dev, \
libopenblas-serial-dev, libepoxy-dev, libembree-dev, libzstd-dev, libfmt-dev, libsqlite3-dev")
include(CPack)
