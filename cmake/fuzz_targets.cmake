# vantage_fuzz_targets(PROGRAM): what the targets of tests/fuzz use. The readers of the program's own
# settings are compiled for it; all others are in libraries.
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)

function(vantage_fuzz_targets program)
  set(settings command_line option_reference setting_help suggestions toml_file)
  list(TRANSFORM settings PREPEND ${PROJECT_SOURCE_DIR}/apps/settings/)
  list(TRANSFORM settings APPEND .cc)
  target_sources(${program} PRIVATE ${settings})
  target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${program} PRIVATE
    vantage_build_flags vantage_options vantage_engine CLI11::CLI11 tomlplusplus::tomlplusplus
    nlohmann_json::nlohmann_json fmt::fmt PkgConfig::libdeflate)
endfunction()
