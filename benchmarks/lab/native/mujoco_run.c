/* MuJoCo without contacts: setup() reads MJCF, run() is mj_forward on one mjData. */
#include <mujoco/mujoco.h>
#include <string.h>

static mjModel *model;
static mjData *data;

int setup(const char *text)
{
    char error[500];
    mjVFS vfs;
    mj_defaultVFS(&vfs);
    mj_addBufferVFS(&vfs, "scene.xml", text, (int)strlen(text));
    model = mj_loadXML("scene.xml", &vfs, error, sizeof error);
    mj_deleteVFS(&vfs);
    if (!model) {
        return 1;
    }
    data = mj_makeData(model);
    return data ? 0 : 2;
}

void run(const double *state, const double *inputs, double *result)
{
    const int n = model->nv;
    memcpy(data->qpos, state, n * sizeof *state);
    memcpy(data->qvel, state + n, n * sizeof *state);
    memcpy(data->qfrc_applied, inputs, n * sizeof *inputs);
    mj_forward(model, data);
    memcpy(result, data->qacc, n * sizeof *result);
}
