# Compiler settings shared by every target, and the function that declares one layer of the architecture.

find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(Threads REQUIRED)
find_package(pegtl REQUIRED)
find_package(CLI11 REQUIRED)
find_package(doctest REQUIRED)

# Results must be the same to the bit on every x86-64 level, so the compiler may not contract a*b+c into one
# rounding. errno and trapping mathematics are given up because with them the random kernels do not vectorise.
add_library(abbe_settings INTERFACE)
target_compile_options(abbe_settings INTERFACE
  -ffp-contract=off -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wconversion -Wshadow -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # g++ 12 warns wrongly inside std::string (GCC bug 105651)
target_include_directories(abbe_settings INTERFACE ${CMAKE_SOURCE_DIR})
option(ABBE_WERROR "Treat warnings as errors" ON)
if(ABBE_WERROR)
  target_compile_options(abbe_settings INTERFACE -Werror)
endif()
set(ABBE_SANITIZE "" CACHE STRING "Sanitizers for every target, for example address,undefined")
if(ABBE_SANITIZE)
  target_compile_options(abbe_settings INTERFACE -fsanitize=${ABBE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(abbe_settings INTERFACE -fsanitize=${ABBE_SANITIZE})
endif()

# abbe_layer(<name> <folder> [USES layer...] [LINKS library...])
# One static library of all .cpp files below the folder. Third-party libraries stay private to the layer.
function(abbe_layer name folder)
  cmake_parse_arguments(ARG "" "" "USES;LINKS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.hpp)
  if(sources)
    add_library(abbe_${name} STATIC ${sources} ${headers})
    target_link_libraries(abbe_${name} PUBLIC abbe_settings PRIVATE ${ARG_LINKS})
    foreach(layer ${ARG_USES})
      target_link_libraries(abbe_${name} PUBLIC abbe_${layer})
    endforeach()
  else()
    add_library(abbe_${name} INTERFACE)
    target_link_libraries(abbe_${name} INTERFACE abbe_settings)
    foreach(layer ${ARG_USES})
      target_link_libraries(abbe_${name} INTERFACE abbe_${layer})
    endforeach()
  endif()
  set_property(GLOBAL APPEND PROPERTY ABBE_LAYERS ${name})
  set_property(GLOBAL PROPERTY ABBE_FOLDER_${name} ${folder})
  set_property(GLOBAL PROPERTY ABBE_USES_${name} ${ARG_USES})
endfunction()
