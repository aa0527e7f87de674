// Pinocchio's articulated-body method, from its headers only; setup() reads one joint a line.
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

#include <memory>
#include <sstream>
#include <string>

using namespace pinocchio;

static Model model;
static std::unique_ptr<Data> data;

static JointModel joint(const std::string &kind)
{
    if (kind == "slide_x") return JointModelPX();
    if (kind == "slide_y") return JointModelPY();
    if (kind == "slide_z") return JointModelPZ();
    if (kind == "turn_x") return JointModelRX();
    if (kind == "turn_y") return JointModelRY();
    if (kind == "turn_z") return JointModelRZ();
    if (kind == "translation") return JointModelTranslation();
    if (kind == "zyx") return JointModelSphericalZYX();
    throw std::invalid_argument(kind);
}

extern "C" int setup(const char *text)
{
    std::istringstream lines(text);
    model = Model();
    lines >> model.gravity.linear()[0] >> model.gravity.linear()[1] >> model.gravity.linear()[2];
    std::string kind;
    int parent;
    while (lines >> parent >> kind) {
        SE3 placement;
        double mass;
        Eigen::Vector3d com;
        Eigen::Matrix3d inertia;
        for (int i = 0; i < 9; i++) lines >> placement.rotation()(i / 3, i % 3);
        for (int i = 0; i < 3; i++) lines >> placement.translation()[i];
        lines >> mass;
        for (int i = 0; i < 3; i++) lines >> com[i];
        for (int i = 0; i < 9; i++) lines >> inertia(i / 3, i % 3);
        const auto id = model.addJoint(parent, joint(kind), placement, "j" + std::to_string(model.njoints));
        model.appendBodyToJoint(id, Inertia(mass, com, inertia), SE3::Identity());
    }
    data = std::make_unique<Data>(model);
    return 0;
}

template <Convention convention>
static void run(const double *state, const double *inputs, double *result)
{
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    const Vector q(state, model.nv), v(state + model.nv, model.nv), tau(inputs, model.nv);
    Eigen::Map<Eigen::VectorXd>(result, model.nv) = aba(model, *data, q, v, tau, convention);
}

extern "C" void run_local(const double *state, const double *inputs, double *result)
{
    run<Convention::LOCAL>(state, inputs, result);
}

extern "C" void run_world(const double *state, const double *inputs, double *result)
{
    run<Convention::WORLD>(state, inputs, result);
}
