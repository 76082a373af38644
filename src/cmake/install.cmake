# Install rules: libraries, headers, the CMake package `odds`, pkg-config files, the command.
include(CMakePackageConfigHelpers)
set(odds_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/odds)

# One export set and one pkg-config file per component, so that a consumer of the core needs no ODE.
function(odds_install_library target)
  get_target_property(name ${target} EXPORT_NAME)
  install(TARGETS ${target} EXPORT odds-${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT odds-${name} NAMESPACE odds:: FILE odds-${name}-targets.cmake DESTINATION ${odds_package_dir})
endfunction()

# What only the library's own code needs has to be linked by everyone when the library is static, by nobody when shared.
# `private_libs`: those that pkg-config does not know.
function(odds_install_pkgconfig name library description requires private_requires private_libs)
  set(libs "-L\${libdir} -l${library} -pthread")
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    string(APPEND requires " ${private_requires}")
    string(APPEND libs " ${private_libs} -lstdc++ -lm")
    set(private_requires "")
  endif()
  file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/cmake/pkgconfig.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

odds_install_library(odds)
odds_install_pkgconfig(odds odds "${PROJECT_DESCRIPTION}" "eigen3" "ccd zlib" "-lboost_context")
if(TARGET odds_ode)
  odds_install_library(odds_ode)
  odds_install_pkgconfig(odds-ode odds_ode "odds as a collision backend of ODE" "odds = ${PROJECT_VERSION} ode >= 0.16" "ccd" "")
endif()
if(TARGET odds_haptics)
  odds_install_library(odds_haptics)
  odds_install_pkgconfig(odds-haptics odds_haptics "Haptic devices, effects, scenes and reports on odds"
    "odds-ode = ${PROJECT_VERSION}" "tomlplusplus fmt zlib pugixml" "")
  install(FILES ${PROJECT_SOURCE_DIR}/docs/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/odds)
endif()
if(TARGET odds_tool)
  set_target_properties(odds_tool PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS odds_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET odds_preload)
  install(TARGETS odds_preload LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
foreach(target odds_ode odds_haptics odds_preload)
  if(TARGET ${target})
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN")
  endif()
endforeach()

set(ODDS_STATIC ON)
if(BUILD_SHARED_LIBS)
  set(ODDS_STATIC OFF)
endif()
configure_package_config_file(cmake/odds-config.cmake.in ${PROJECT_BINARY_DIR}/odds-config.cmake
  INSTALL_DESTINATION ${odds_package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/odds-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/odds-config.cmake ${PROJECT_BINARY_DIR}/odds-config-version.cmake
  DESTINATION ${odds_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
