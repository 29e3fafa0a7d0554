# Installs the library into a scratch folder, builds the example against it as a stranger would, and bakes a scene with it.
# cmake -DBUILD=... -DSOURCE=... -DSCENE=... -DWORK=... -P check.cmake
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()
file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/bake_ao ${SCENE} ${WORK}/out.glb)
file(SIZE ${WORK}/out.glb size)
if(size LESS 10000)
  message(FATAL_ERROR "out.glb has only ${size} bytes")
endif()
