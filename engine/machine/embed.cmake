# abbe_embed_machines(<layer>): the machine files of examples/machines as string constants of the layer (engine/machine/shipped.hpp).
# This file is also the script that writes them (cmake -DFOLDER=... -DOUTPUT=... -P), so that editing a machine rebuilds them.
if(CMAKE_SCRIPT_MODE_FILE)
  file(GLOB machines ${FOLDER}/*.json)
  list(SORT machines)
  set(entries "")
  foreach(machine ${machines})
    get_filename_component(name ${machine} NAME_WE)
    file(READ ${machine} text)
    string(APPEND entries "    {\"${name}\", R\"machine(${text})machine\"},\n")
  endforeach()
  file(WRITE ${OUTPUT} "#include \"engine/machine/shipped.hpp\"\n\nnamespace abbe {\n\nnamespace {\n"
    "constexpr ShippedFile kFiles[] = {\n${entries}};\n}  // namespace\n\n"
    "std::span<const ShippedFile> shipped_machine_files() { return kFiles; }\n\n}  // namespace abbe\n")
  return()
endif()

set(ABBE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(abbe_embed_machines layer)
  set(folder ${CMAKE_SOURCE_DIR}/examples/machines)
  set(output ${CMAKE_BINARY_DIR}/shipped_machines.cpp)
  file(GLOB machines CONFIGURE_DEPENDS ${folder}/*.json)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DOUTPUT=${output} -P ${ABBE_EMBED_SCRIPT}
    DEPENDS ${machines} ${ABBE_EMBED_SCRIPT} VERBATIM)
  target_sources(abbe_${layer} PRIVATE ${output})
  add_custom_target(abbe_shipped_machines DEPENDS ${output})  # for other targets that compile it
endfunction()
