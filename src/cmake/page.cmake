# Embeds what a report page is made of (style, script, glossary, chart library) into a library, so that the program needs
# no file at run time and the page none at all.
function(odds_embed_page target directory)
  find_file(ODDS_CHART_LIBRARY NAMES chart.min.js chart.umd.js
    PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist
    DOC "Chart.js 3 or 4, minified, for the charts of report pages")
  set(chart_library ${directory}/no_charts.js)
  set(chart_version "")
  if(ODDS_CHART_LIBRARY AND EXISTS "${ODDS_CHART_LIBRARY}")
    file(READ ${ODDS_CHART_LIBRARY} notice LIMIT 400)
    file(STRINGS ${ODDS_CHART_LIBRARY} closing_tags REGEX "</[sS][cC][rR][iI][pP][tT]" LIMIT_COUNT 1)
    if(notice MATCHES "Chart\\.js v([34]\\.[0-9.]+)" AND NOT closing_tags)
      set(chart_version ${CMAKE_MATCH_1})
      set(chart_library ${ODDS_CHART_LIBRARY})
    endif()
  endif()
  if(chart_version)
    message(STATUS "Report pages: charts by Chart.js ${chart_version} (${chart_library})")
  else()
    message(STATUS "Report pages: tables only; for charts install libjs-chart.js or set ODDS_CHART_LIBRARY to Chart.js 3 or 4")
  endif()

  # The content security policy names scripts by their digest; a changed file must configure anew.
  foreach(script IN ITEMS ${chart_library} ${directory}/charts.js ${directory}/accuracy.js)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
  endforeach()
  file(SHA256 ${chart_library} chart_digest)
  file(SHA256 ${directory}/charts.js script_digest)
  file(SHA256 ${directory}/accuracy.js accuracy_digest)
  set(page_directory ${directory})
  configure_file(${directory}/assets.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/page_assets.cpp @ONLY)
  set_property(SOURCE ${CMAKE_CURRENT_BINARY_DIR}/page_assets.cpp APPEND PROPERTY OBJECT_DEPENDS
    "${chart_library};${directory}/charts.js;${directory}/accuracy.js;${directory}/style.css;${directory}/glossary.html")
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/page_assets.cpp)
endfunction()
