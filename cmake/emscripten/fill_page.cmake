# Writes the page of apps/pages/browser_page, in which every {{NAME}} becomes a file of its folder or
# the engine: cmake -D OUTPUT=FILE.html -D FOLDER=DIR -D ENGINE=FILE.js -D VERSION=X.Y.Z -P …
file(READ "${FOLDER}/page.html" page)
file(READ "${ENGINE}" engine)
string(REPLACE "{{version}}" "${VERSION}" page "${page}")
foreach(name page.css pictures.js page.js worker.js)
  file(READ "${FOLDER}/${name}" text)
  string(REPLACE "{{${name}}}" "${text}" page "${page}")
endforeach()
if(engine MATCHES "</script")
  message(FATAL_ERROR "${ENGINE} holds </script, which ends its element of the page")
endif()
string(REPLACE "{{engine}}" "${engine}" page "${page}")
file(WRITE "${OUTPUT}" "${page}")
