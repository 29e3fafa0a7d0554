# Writes the rows of a C++ table {name, text} out of text files. Usage: cmake -DOUT=table.inc "-DFILES=a.glsl;b.glsl" -P EmbedShaders.cmake
set(rows "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND rows "{\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUT} "${rows}")
