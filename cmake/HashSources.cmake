# Writes a header with the SHA-256 of source files: what is made by them is known to be stale when they change.
#   cmake -D OUT=header -D NAME=kConstant -D FILES=a.cpp,b.cpp -P HashSources.cmake
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" files "${FILES}")
set(hashes "")
foreach(file IN LISTS files)
  file(SHA256 "${file}" hash)
  string(APPEND hashes "${hash}")
endforeach()
string(SHA256 all "${hashes}")
file(CONFIGURE OUTPUT "${OUT}" CONTENT
"#pragma once

// Made by cmake/HashSources.cmake.
inline constexpr const char* @NAME@ = \"@all@\";
" @ONLY)
