# cmake -DPROGRAM=FILE -DVERSION=X -DPAGE=FILE -P Manual.cmake: a page of the manual, from what a program says of itself.
get_filename_component(name ${PROGRAM} NAME)
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\\" "\\e" help "${help}")
string(REPLACE "-" "\\-" help "${help}")
string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" help "${help}")
string(REGEX MATCH "^[^\n]+" what "${help}")
file(WRITE ${PAGE} ".TH ${name} 1 \"\" \"mrpt_semantic_octree ${VERSION}\"\n.SH NAME\n${name} \\- ${what}\n"
  ".SH DESCRIPTION\n.nf\n${help}.fi\n")
