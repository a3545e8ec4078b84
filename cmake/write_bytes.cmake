# cmake -D INPUT=FILE -D OUTPUT=FILE -P write_bytes.cmake: the bytes of INPUT as text for a C++ array, line by line.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REPLACE "0x0a," "0x0a,\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "${bytes}")
