# Debian packages, one per component: cpack in the build folder, or scripts/package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Vantage developers <maintainers@vantage.invalid>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(CMAKE_CROSSCOMPILING)  # by the toolchain file, which names the architecture
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${VANTAGE_DEBIAN_ARCHITECTURE})
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
    ${CMAKE_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}
    ${CMAKE_SYSROOT}/lib/${CMAKE_LIBRARY_ARCHITECTURE})
  # What cpack runs asks for the packages of the other architecture.
  set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/cpack_environment.cmake)
  file(WRITE ${CPACK_PROJECT_CONFIG_FILE}
    "set(ENV{DEB_HOST_ARCH} ${VANTAGE_DEBIAN_ARCHITECTURE})\n"
    "set(ENV{DPKG_ADMINDIR} ${CMAKE_SYSROOT}/var/lib/dpkg)\n")
endif()

# packages_of(VARIABLE LIBRARY...): the packages of libraries that are opened at run time
# (engine/late_library.h), which dpkg-shlibdeps does not see.
function(packages_of variable)
  set(packages "")
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      get_target_property(library ${library} LOCATION)
    endif()
    file(REAL_PATH ${library} file)
    cmake_path(GET file FILENAME name)
    execute_process(COMMAND dpkg-query -S "*/${name}"
      OUTPUT_VARIABLE owner ERROR_QUIET RESULT_VARIABLE result)
    if(result EQUAL 0)
      string(REGEX REPLACE "[:,].*" "" package "${owner}")
      list(APPEND packages ${package})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  list(JOIN packages ", " packages)
  set(${variable} "${packages}" PARENT_SCOPE)
endfunction()

# debian_package(COMPONENT NAME SECTION DEPENDS SUMMARY TEXT)
macro(debian_package component name section depends summary text)
  string(TOUPPER ${component} key)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${summary}\n${text}")
  set(document_dir ${CMAKE_INSTALL_DATADIR}/doc/${name})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright DESTINATION ${document_dir}
    COMPONENT ${component})
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${document_dir}
    COMPONENT ${component})
endmacro()

find_program(DPKG_QUERY dpkg-query)
if(NOT DPKG_QUERY)
  return()  # not a Debian system
endif()
configure_file(cmake/debian/changelog.in changelog @ONLY)
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)

packages_of(late_libraries opencv_imgcodecs opencv_video ${TIFF_LIBRARY} ${libav_LINK_LIBRARIES})
# Only boards with markers and --show need them, and they bring a window system; only addresses need
# libcurl and the certificates.
packages_of(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS opencv_aruco ${libcurl_LINK_LIBRARIES})
string(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
  ", ca-certificates, libopencv-highgui${OpenCV_VERSION_MAJOR}0${OpenCV_VERSION_MINOR}")
debian_package(program vantage graphics "${late_libraries}"
  "disparity maps and new views of stereo pairs and sequences"
  "Turns rectified stereo pairs, folders of pairs and stereo videos into
disparity maps and new views, on all cores of ordinary processors. Results do
not depend on the number of threads.")
debian_package(library libvantage0 libs "${late_libraries}"
  "shared library of the stereo engine Vantage"
  "Disparity maps and new views of stereo pairs in memory, for programs in any
language.")
debian_package(development libvantage-dev libdevel
  "libvantage0 (= ${PROJECT_VERSION}), libtbb-dev, libopencv-dev, libeigen3-dev, libfmt-dev, libhwy-dev, libhwloc-dev, libdeflate-dev, \
libjpeg-dev, libpng-dev, pkg-config, ${late_libraries}"
  "libraries of the stereo engine Vantage for developers"
  "Headers, static libraries and CMake packages: find_package(vantage) gives the
shared library vantage::vantage with a C interface, find_package(Vantage) the
static vantage::engine, in C++.")
# What cpack puts into packages; it would build all targets itself, tests among them.
add_custom_target(vantage_packaged DEPENDS vantage vantage_reference vantage_engine vantage_shared)
if(TARGET vantage_python)
  packages_of(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS ${libcurl_LINK_LIBRARIES})
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS ", ca-certificates")
  debian_package(python python3-vantage python
    "python3 (>= ${VANTAGE_PYTHON_VERSION}), \
python3 (<< ${VANTAGE_NEXT_PYTHON}), python3-numpy, ${late_libraries}"
    "Python module of the stereo engine Vantage"
    "The module vantage: disparity maps, new views and points of stereo pairs in
NumPy arrays.")
  add_dependencies(vantage_packaged vantage_python)
endif()
include(CPack)
