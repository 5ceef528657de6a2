# Uses ccache and mold where they are installed.
option(VANTAGE_USE_CCACHE "Compile through ccache where it is installed" ${PROJECT_IS_TOP_LEVEL})
option(VANTAGE_USE_MOLD "Link with mold where it is installed" ${PROJECT_IS_TOP_LEVEL})

find_program(VANTAGE_CCACHE ccache)
if(VANTAGE_USE_CCACHE AND VANTAGE_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths below the checkout become relative and the folder does not count, so that checkouts in
  # different places share what is compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    /usr/bin/env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${VANTAGE_CCACHE})
endif()

find_program(VANTAGE_MOLD mold)
if(VANTAGE_USE_MOLD AND VANTAGE_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"
    AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.1)
  add_link_options(-fuse-ld=mold)
endif()
